#include "overlay.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>

#include <mirrorball/projection.h>

#include "theme.h"
#include "view_window.h"

namespace mirrorball::window {
namespace {

constexpr double kMessageSeconds = 8;
constexpr float kGrip = 8;  // how near to the wipe's line the mouse has hold of it

float f(double value) {
    return static_cast<float>(value);
}

// By hand
// ---------------------------------------------------------------------------------------------

float wipe_line(const Session& session) {
    return f(session.picture.left + session.viewer.comparison().wipe * session.picture.width);
}

void move_wipe(Session& session, float x) {
    session.edit_comparison([&](Comparison& comparison) {
        comparison.wipe = (x - session.picture.left) / session.picture.width;
    });
}

void drag(Session& session, const ImGuiIO& io) {
    if (ImGui::IsItemActivated()) {
        session.holds_wipe = session.viewer.comparison().showing == Showing::wipe &&
                             std::abs(io.MousePos.x - wipe_line(session)) < kGrip * session.scale &&
                             ImGui::IsMouseDown(ImGuiMouseButton_Left);
    }
    if (session.holds_wipe) return move_wipe(session, io.MousePos.x);
    const int height = session.picture.height;
    const ImVec2 d = io.MouseDelta;
    if (d.x == 0 && d.y == 0) return;
    const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (!left || io.KeyShift) {
        session.viewer.pan(d.x, d.y, height);
    } else if (io.KeyCtrl) {
        session.attempt([&] { session.viewer.turn_environment(d.x, height); });
    } else {
        session.viewer.orbit(d.x, d.y, height);
    }
}

void use_hand(Session& session) {
    const ImGuiIO& io = ImGui::GetIO();
    const Area& area = session.picture;
    ImGui::InvisibleButton("##picture", {f(std::max(1, area.width)), f(std::max(1, area.height))},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    const bool hovered = ImGui::IsItemHovered();
    if (ImGui::IsItemActive()) drag(session, io);
    if (hovered && io.MouseWheel != 0) session.viewer.zoom(io.MouseWheel);
    session.hover.reset();
    if (!hovered && !ImGui::IsItemActive()) return;
    session.hover = session.viewer.hover(io.MousePos.x - area.left, io.MousePos.y - area.top,
                                         area.width, area.height);
    const bool clicked = ImGui::IsItemDeactivated() && io.MouseDragMaxDistanceSqr[0] < 9;
    if (clicked && session.hover->object) session.viewer.select(*session.hover->object);
    if (session.viewer.comparison().showing == Showing::wipe &&
        std::abs(io.MousePos.x - wipe_line(session)) < kGrip * session.scale)
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
}

// Texts
// ---------------------------------------------------------------------------------------------

struct Box {
    ImVec2 least, most;
};

// Text on a shade, its corner at `at`, which `anchor` moves by shares of its size.
Box label(Session& session, const std::string& text, const ImVec2& at, const ImVec2& anchor,
          ImU32 color = kFaint, float wrap = 0) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float pad = f(7 * session.scale);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
    const ImVec2 least(at.x - anchor.x * (size.x + 2 * pad), at.y - anchor.y * (size.y + 2 * pad));
    const ImVec2 most(least.x + size.x + 2 * pad, least.y + size.y + 2 * pad);
    list.AddRectFilled(least, most, kShade, f(5 * session.scale));
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {least.x + pad, least.y + pad}, color,
                 text.c_str(), nullptr, wrap);
    return {least, most};
}

void wipe_labels(Session& session) {
    const Area& area = session.picture;
    const float x = wipe_line(session), top = f(area.top), gap = f(10 * session.scale);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine({x, top}, {x, top + f(area.height)}, IM_COL32(0, 0, 0, 110), f(3 * session.scale));
    list.AddLine({x, top}, {x, top + f(area.height)}, IM_COL32(255, 255, 255, 220),
                 f(session.scale));
    const float middle = top + f(area.height) / 2, radius = f(9 * session.scale);
    list.AddCircleFilled({x, middle}, radius, IM_COL32(255, 255, 255, 230), 24);
    for (const float side : {-1.0f, 1.0f}) {
        const float inner = x + side * radius * 0.25f, outer = x + side * radius * 0.68f;
        list.AddTriangleFilled({outer, middle}, {inner, middle - radius * 0.4f},
                               {inner, middle + radius * 0.4f}, IM_COL32(30, 30, 30, 255));
    }
    label(session, std::string(name(session.viewer.scene().method)), {x - gap, top + gap}, {1, 0},
          kAccent);
    label(session, std::string(name(session.viewer.comparison().other)), {x + gap, top + gap},
          {0, 0}, kSecond);
}

void difference_labels(Session& session) {
    const Area& area = session.picture;
    const Comparison& comparison = session.viewer.comparison();
    const float gap = f(10 * session.scale);
    label(session,
          fmt::format(
              "{} \u2212 {}: black 0, violet, red, orange, white {:.3g} of what a screen shows",
              name(session.viewer.scene().method), name(comparison.other), comparison.full_scale),
          {f(area.left) + gap, f(area.top) + gap}, {0, 0});
}

std::string vector_text(const Vec3d& v) {
    return fmt::format("{:+.2f} {:+.2f} {:+.2f}", v.x, v.y, v.z);
}

// Where a direction is looked up in the map that the method has.
std::string looked_up(Session& session, const Vec3d& direction) {
    const Projection projection = projection_of(session.viewer.scene().method);
    const MapPlace place = session.viewer.place_on_map(projection, direction);
    static constexpr const char* kCubeFaces[] = {"+X ", "-X ", "+Y ", "-Y ", "+Z ", "-Z "};
    static constexpr const char* kHalves[] = {"front ", "back "};
    const char* face = projection == Projection::cube              ? kCubeFaces[place.face]
                       : projection == Projection::dual_paraboloid ? kHalves[place.face]
                                                                   : "";
    return fmt::format("{} {}s {:.3f} t {:.3f}", name(projection), face, place.s, place.t);
}

void hover_text(Session& session) {
    if (!session.hover) return;
    const Hover& hover = *session.hover;
    std::string text;
    if (hover.object) {
        const SceneObject& object = session.viewer.scene().objects[*hover.object];
        text = fmt::format(
            "{}   p {}   n {}\nr {}   \u2192 {}",
            object.name.empty() ? std::filesystem::path(object.mesh).filename().string()
                                : object.name,
            vector_text(hover.position), vector_text(hover.normal),
            vector_text(hover.reflected.normalized()), looked_up(session, hover.reflected));
        if (hover.refracted)
            text += fmt::format("\nt {}   \u2192 {}", vector_text(hover.refracted->normalized()),
                                looked_up(session, *hover.refracted));
    } else {
        text = fmt::format("background   {}   \u2192 {}", vector_text(hover.reflected.normalized()),
                           looked_up(session, hover.reflected));
    }
    const Area& area = session.picture;
    const float gap = f(10 * session.scale);
    label(session, text, {f(area.left) + gap, f(area.top + area.height) - gap}, {0, 1});
}

void message_text(Session& session) {
    if (!session.message) return;
    if (session.clock - session.message->since > kMessageSeconds) return session.message.reset();
    const Area& area = session.picture;
    const ImU32 color =
        session.message->is_error ? IM_COL32(255, 120, 105, 255) : IM_COL32(150, 225, 160, 255);
    label(session, session.message->text,
          {f(area.left + area.width / 2.0), f(area.top + 44 * session.scale)}, {0.5f, 0}, color,
          f(area.width * 0.8));
}

void help_text(Session& session) {
    if (!session.help_open) return;
    const Area& area = session.picture;
    ImGui::SetNextWindowPos({f(area.left + area.width / 2.0), f(area.top + area.height / 2.0)},
                            ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, f(8 * session.scale));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(14, 16, 20, 240));
    ImGui::Begin("##help", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
    const auto row = [&](const std::string& keys, const std::string& what) {
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kAccent), "%s", keys.c_str());
        ImGui::SameLine(f(130 * session.scale));
        ImGui::TextUnformatted(what.c_str());
    };
    row("Drag", "turn the view; with Shift or the right button, move it");
    row("Ctrl drag", "turn the environment");
    row("Wheel", "nearer, farther");
    row("Click", "choose an object");
    ImGui::Separator();
    for (const KeyHelp& help : Viewer::keys()) row(help.keys, help.what);
    ImGui::Separator();
    for (const KeyHelp& help : window_keys()) row(help.keys, help.what);
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

}  // namespace

void draw_overlay(Session& session) {
    const Area& area = session.picture;
    ImGui::SetNextWindowPos({f(area.left), f(area.top)});
    ImGui::SetNextWindowSize({f(area.width), f(area.height)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::Begin("##over", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus);
    use_hand(session);
    if (session.viewer.comparison().showing == Showing::wipe) wipe_labels(session);
    if (session.viewer.comparison().showing == Showing::difference) difference_labels(session);
    if (session.panel_open) hover_text(session);
    message_text(session);
    ImGui::End();
    ImGui::PopStyleVar();
    help_text(session);
}

}  // namespace mirrorball::window
