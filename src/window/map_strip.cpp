#include "map_strip.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "theme.h"

namespace mirrorball::window {
namespace {

struct ShownMap {
    Projection projection;
    const char* title;
};
constexpr ShownMap kMaps[] = {{Projection::cube, "cube"},
                              {Projection::sphere, "sphere"},
                              {Projection::dual_paraboloid, "two paraboloids"},
                              {Projection::equirect, "panorama"},
                              {Projection::octahedral, "octahedral"},
                              {Projection::angular, "angular"}};
constexpr float kMostHeight = 120, kGap = 10, kContents = 96, kPadding = 10;

// Of one map in a strip that is so wide; all have one height.
float map_height(float width, float scale) {
    float aspects = 0;
    for (const ShownMap& map : kMaps)
        aspects += static_cast<float>(map_picture_aspect(map.projection));
    const float gaps =
        (kGap * static_cast<float>(std::size(kMaps)) + kContents + 2 * kPadding) * scale;
    return std::clamp((width - gaps) / aspects, 16.0f, kMostHeight * scale);
}

void marker(ImDrawList& list, const ImVec2& at, ImU32 color, float scale) {
    const float radius = 5 * scale;
    list.AddCircle(at, radius, IM_COL32(0, 0, 0, 200), 20, 4 * scale);
    list.AddCircle(at, radius, color, 20, 2 * scale);
    list.AddCircleFilled(at, 1.5f * scale, color);
}

}  // namespace

int MapStrip::height_for(int width, double scale) {
    const auto s = static_cast<float>(scale);
    return static_cast<int>(map_height(static_cast<float>(width), s) + 2 * kPadding * s +
                            ImGui::GetTextLineHeightWithSpacing());
}

GLuint MapStrip::texture_of(Session& session, Projection projection, int height) {
    const ScreenPicture& picture = session.viewer.map_picture(session.content, projection, height);
    Uploaded& uploaded = uploaded_[{session.content, projection}];
    if (uploaded.version == picture.version) return uploaded.name.name();
    glBindTexture(GL_TEXTURE_2D, uploaded.name.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.width, picture.height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, picture.rgba.data());
    uploaded.version = picture.version;
    return uploaded.name.name();
}

void MapStrip::draw(Session& session, const Area& area) {
    const auto scale = static_cast<float>(session.scale);
    const float height = map_height(static_cast<float>(area.width), scale);
    ImGui::SetNextWindowPos({static_cast<float>(area.left), static_cast<float>(area.top)});
    ImGui::SetNextWindowSize({static_cast<float>(area.width), static_cast<float>(area.height)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {kPadding * scale, kPadding * scale * 0.7f});
    ImGui::Begin("##maps", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::BeginGroup();
    ImGui::TextDisabled("Maps of");
    for (const MapContent content :
         {MapContent::environment, MapContent::glossy, MapContent::diffuse}) {
        const bool chosen = session.content == content;
        const std::string title(content == MapContent::environment ? "light" : name(content));
        if (ImGui::Selectable(title.c_str(), chosen, 0, {(kContents - 16) * scale, 0}))
            session.content = content;
    }
    ImGui::EndGroup();

    float left = static_cast<float>(area.left) + (kPadding + kContents) * scale;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float top = static_cast<float>(area.top) + kPadding * scale * 0.7f;
    for (const ShownMap& map : kMaps) {
        const float width = height * static_cast<float>(map_picture_aspect(map.projection));
        const GLuint texture = texture_of(session, map.projection, static_cast<int>(height));
        const float under = top + ImGui::GetTextLineHeightWithSpacing();
        list.AddText({left, top}, ImGui::GetColorU32(ImGuiCol_TextDisabled), map.title);
        list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)),
                      {left, under}, {left + width, under + height});
        if (session.hover) {
            const auto mark = [&](const Vec3d& direction, ImU32 color) {
                const MapPlace place = session.viewer.place_on_map(map.projection, direction);
                marker(list,
                       {left + static_cast<float>(place.x) * width,
                        under + static_cast<float>(place.y) * height},
                       color, scale);
            };
            if (session.hover->refracted) mark(*session.hover->refracted, kSecond);
            mark(session.hover->reflected, kAccent);
        }
        left += width + kGap * scale;
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace mirrorball::window
