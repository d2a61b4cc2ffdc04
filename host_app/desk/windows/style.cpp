#include "host_app/desk/windows/style.h"

#include <filesystem>

namespace vantage {
namespace {

ImFont* load_font(const char* file, float letter_px) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const std::filesystem::path path =
        std::filesystem::path("/usr/share/fonts/truetype/dejavu") / file;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored))
        if (ImFont* font = atlas.AddFontFromFileTTF(path.c_str(), letter_px)) return font;
    ImFontConfig built_in;
    built_in.SizePixels = letter_px;
    return atlas.AddFontDefault(&built_in);
}

}  // namespace

UiContext::UiContext(float letter_px) : context_(ImGui::CreateContext()) {
    make_current();
    ImGuiIO& io = ImGui::GetIO();
    // ImGui keeps nothing between sessions.
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.DeltaTime = 1;  // there are no animations
    ImGui::StyleColorsDark();
    set_letter_px(letter_px);
}

UiContext::~UiContext() { ImGui::DestroyContext(context_); }

void UiContext::set_letter_px(float letter_px) {
    if (letter_px == letter_px_) return;
    letter_px_ = letter_px;
    ImGui::GetIO().Fonts->Clear();
    fonts_.body = load_font("DejaVuSans.ttf", letter_px);
    fonts_.strong = load_font("DejaVuSans-Bold.ttf", letter_px);
}

}  // namespace vantage
