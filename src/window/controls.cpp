#include "controls.h"

#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace mirrorball::window {
namespace {

constexpr float kLabelShare = 0.36f;

// The label to the left; what follows takes the rest of the row and is named "##label".
std::string begin_row(const char* label) {
    const float left = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label);
    ImGui::SameLine(left + width * kLabelShare);
    ImGui::SetNextItemWidth(-1);
    return fmt::format("##{}", label);
}

}  // namespace

bool slider(const char* label, double& value, double least, double most, const char* format,
            bool logarithmic) {
    const std::string name = begin_row(label);
    float shown = static_cast<float>(value);
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp |
        (logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    if (!ImGui::SliderFloat(name.c_str(), &shown, static_cast<float>(least),
                            static_cast<float>(most), format, flags))
        return false;
    value = std::fmin(std::fmax(shown, least), most);
    return true;
}

bool degrees(const char* label, double& radians, double least, double most) {
    double value = radians * 180 / kPi;
    if (!slider(label, value, least, most, "%.0f\u00b0")) return false;
    radians = value * kPi / 180;
    return true;
}

bool color(const char* label, Vec3d& value) {
    const std::string name = begin_row(label);
    float shown[3] = {static_cast<float>(value.x), static_cast<float>(value.y),
                      static_cast<float>(value.z)};
    if (!ImGui::ColorEdit3(name.c_str(), shown, ImGuiColorEditFlags_Float)) return false;
    for (int i = 0; i < 3; ++i) value[i] = std::fmin(std::fmax(shown[i], 0), 1);
    return true;
}

bool vector(const char* label, Vec3d& value, double speed) {
    const std::string name = begin_row(label);
    float shown[3] = {static_cast<float>(value.x), static_cast<float>(value.y),
                      static_cast<float>(value.z)};
    if (!ImGui::DragFloat3(name.c_str(), shown, static_cast<float>(speed), 0, 0, "%.2f"))
        return false;
    value = {shown[0], shown[1], shown[2]};
    return true;
}

bool checkbox(const char* label, bool& value) {
    const std::string name = begin_row(label);
    return ImGui::Checkbox(name.c_str(), &value);
}

bool choose(const char* label, std::span<const Choice> choices, int& index,
            const std::string& shown) {
    const std::string name = begin_row(label);
    const std::string& text = index >= 0 ? choices[static_cast<std::size_t>(index)].text : shown;
    bool changed = false;
    if (ImGui::BeginCombo(name.c_str(), text.c_str(), ImGuiComboFlags_HeightLarge)) {
        for (int i = 0; i < static_cast<int>(choices.size()); ++i) {
            const Choice& choice = choices[static_cast<std::size_t>(i)];
            if (ImGui::Selectable(choice.text.c_str(), i == index) && i != index)
                index = i, changed = true;
            if (i == index) ImGui::SetItemDefaultFocus();
            if (ImGui::IsItemHovered() && !choice.tip.empty())
                ImGui::SetTooltip("%s", choice.tip.c_str());
        }
        ImGui::EndCombo();
    }
    return changed;
}

bool begin_group(const char* title, bool open) {
    const bool shown = ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    if (shown) {
        ImGui::PushID(title);
        ImGui::Dummy({0, 1});
    }
    return shown;
}

void end_group() {
    ImGui::Dummy({0, 4});
    ImGui::PopID();
}

void note(std::string_view text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.data(), text.data() + text.size());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

}  // namespace mirrorball::window
