#include "host_app/desk/style.h"

#include <cmath>
#include <filesystem>

namespace vantage {
namespace {

ImFont* load_font(const char* file, float height_px) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const std::filesystem::path path =
        std::filesystem::path("/usr/share/fonts/truetype/dejavu") / file;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored))
        if (ImFont* font = atlas.AddFontFromFileTTF(path.c_str(), height_px)) return font;
    ImFontConfig built_in;
    built_in.SizePixels = height_px;
    return atlas.AddFontDefault(&built_in);
}

void set_style(float body_px) {
    ImGuiStyle& style = ImGui::GetStyle();
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = style.ChildRounding = 4;
    style.FrameRounding = 3;
    style.WindowBorderSize = 1;
    style.WindowPadding = {0.8f * body_px, 0.6f * body_px};
    style.ItemSpacing = {0.5f * body_px, 0.35f * body_px};
    style.CellPadding = {0.3f * body_px, 0.2f * body_px};
    style.AntiAliasedLines = style.AntiAliasedFill = true;
    style.Colors[ImGuiCol_Text] = palette::text;
    style.Colors[ImGuiCol_TextDisabled] = palette::dim;
    style.Colors[ImGuiCol_WindowBg] = palette::panel;
    style.Colors[ImGuiCol_Border] = palette::line;
    style.Colors[ImGuiCol_Separator] = palette::line;
    style.Colors[ImGuiCol_TableBorderLight] = palette::line;
    style.Colors[ImGuiCol_TableHeaderBg] = {0, 0, 0, 0};
    style.Colors[ImGuiCol_FrameBg] = {1, 1, 1, 0.05f};
    style.Colors[ImGuiCol_PlotHistogram] = palette::accent;
    style.Colors[ImGuiCol_PlotLines] = palette::accent;
}

}  // namespace

UiContext::UiContext(float body_px) : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    // Panels stand where they stand; nothing is kept between sessions.
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    set_style(body_px);
    fonts_.body = load_font("DejaVuSans.ttf", std::round(body_px));
    fonts_.strong = load_font("DejaVuSans-Bold.ttf", std::round(body_px));
    fonts_.title = load_font("DejaVuSans-Bold.ttf", std::round(1.25f * body_px));
}

UiContext::~UiContext() { ImGui::DestroyContext(context_); }

}  // namespace vantage
