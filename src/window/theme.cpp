#include "theme.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

namespace mirrorball::window {
namespace {

constexpr float kTextSize = 14.5f;
// Debian's fonts-dejavu-core, fonts-noto-core and fonts-liberation.
constexpr std::array kFonts = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                               "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
                               "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"};
// Latin, and the arrows and signs that help texts have.
constexpr ImWchar kGlyphs[] = {0x20, 0xff, 0x2010, 0x2026, 0x2190, 0x2193, 0x2212, 0x2212, 0};

void load_font(float size) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    for (const char* path : kFonts) {
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored)) continue;
        ImFontConfig config;
        config.OversampleH = 2, config.OversampleV = 1;
        if (fonts.AddFontFromFileTTF(path, size, &config, kGlyphs) != nullptr) return;
    }
    ImFontConfig config;
    config.SizePixels = size;
    fonts.AddFontDefault(&config);
}

ImVec4 grey(float level, float alpha = 1) {
    return {level * 0.96f, level, level * 1.08f, alpha};
}

void set_colors(ImGuiStyle& style) {
    ImGui::StyleColorsDark(&style);
    const ImVec4 accent(0.93f, 0.58f, 0.18f, 1), quiet(0.93f, 0.58f, 0.18f, 0.55f);
    const auto set = [&](ImGuiCol which, const ImVec4& color) { style.Colors[which] = color; };
    set(ImGuiCol_Text, grey(0.88f));
    set(ImGuiCol_TextDisabled, grey(0.5f));
    set(ImGuiCol_WindowBg, grey(0.085f));
    set(ImGuiCol_ChildBg, grey(0.085f));
    set(ImGuiCol_PopupBg, grey(0.12f, 0.98f));
    set(ImGuiCol_Border, grey(0.2f));
    set(ImGuiCol_FrameBg, grey(0.16f));
    set(ImGuiCol_FrameBgHovered, grey(0.21f));
    set(ImGuiCol_FrameBgActive, grey(0.25f));
    set(ImGuiCol_Header, grey(0.15f));
    set(ImGuiCol_HeaderHovered, grey(0.2f));
    set(ImGuiCol_HeaderActive, grey(0.24f));
    set(ImGuiCol_Button, grey(0.2f));
    set(ImGuiCol_ButtonHovered, grey(0.27f));
    set(ImGuiCol_ButtonActive, quiet);
    // Numbers are written over it.
    set(ImGuiCol_SliderGrab, {0.62f, 0.4f, 0.15f, 1});
    set(ImGuiCol_SliderGrabActive, {0.75f, 0.48f, 0.17f, 1});
    set(ImGuiCol_CheckMark, accent);
    set(ImGuiCol_Separator, grey(0.2f));
    set(ImGuiCol_ScrollbarBg, grey(0.085f));
    set(ImGuiCol_ScrollbarGrab, grey(0.22f));
    set(ImGuiCol_NavHighlight, accent);
    set(ImGuiCol_TextSelectedBg, quiet);
}

}  // namespace

void apply_theme(double scale) {
    load_font(std::round(kTextSize * static_cast<float>(scale)));
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    set_colors(style);
    style.WindowPadding = {12, 10};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {7, 4};
    style.WindowRounding = 0;
    style.FrameRounding = 4;
    style.GrabRounding = 4;
    style.PopupRounding = 5;
    style.ScrollbarRounding = 6;
    style.ScrollbarSize = 11;
    style.GrabMinSize = 9;
    style.WindowBorderSize = 0;
    style.ScaleAllSizes(static_cast<float>(scale));
}

}  // namespace mirrorball::window
