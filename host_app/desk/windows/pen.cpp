#include "host_app/desk/windows/pen.h"

#include <cmath>
#include <filesystem>

#include "host_app/desk/windows/ui_renderer.h"

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

constexpr float far_away = 1e6f;

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

const ImVec4& colour_of(Mark mark) {
    switch (mark) {
        case Mark::good:
            return palette::good;
        case Mark::care:
            return palette::warn;
        case Mark::bad:
            break;
    }
    return palette::bad;
}

Pen Pen::dry() const {
    Pen pen = *this;
    pen.draws_ = false;
    return pen;
}

void Pen::words_at(float x, float y, const ImVec4& colour, std::string_view words, bool is_strong,
                   float wrap_width) const {
    // Text is sharp only at whole pixels.
    if (draws_)
        list().AddText(font(is_strong), em(), {std::round(x), std::round(y)}, packed(colour),
                       words.data(), words.data() + words.size(), wrap_width);
}

float Pen::width_of(std::string_view words, bool is_strong) const {
    return font(is_strong)
        ->CalcTextSizeA(em(), far_away, 0, words.data(), words.data() + words.size())
        .x;
}

float Pen::text(float x, float y, const ImVec4& colour, std::string_view words,
                bool is_strong) const {
    words_at(x, y, colour, words, is_strong);
    return x + width_of(words, is_strong);
}

void Pen::text_right(float right, float y, const ImVec4& colour, std::string_view words,
                     bool is_strong) const {
    text(right - width_of(words, is_strong), y, colour, words, is_strong);
}

float Pen::text_until(float right, float x, float y, const ImVec4& colour, std::string_view words,
                      bool is_strong) const {
    if (x + width_of(words, is_strong) <= right) return text(x, y, colour, words, is_strong);
    constexpr std::string_view ellipsis = "...";
    const float room = right - x - width_of(ellipsis, is_strong);
    if (room <= 0) return x;
    const char* end = nullptr;
    font(is_strong)->CalcTextSizeA(em(), room, 0, words.data(), words.data() + words.size(), &end);
    x = text(x, y, colour, {words.data(), static_cast<std::size_t>(end - words.data())}, is_strong);
    return text(x, y, colour, ellipsis, is_strong);
}

float Pen::text_wrapped(float width, float x, float y, const ImVec4& colour,
                        std::string_view words) const {
    words_at(x, y, colour, words, false, width);
    const char* end = words.data() + words.size();
    return font(false)->CalcTextSizeA(em(), far_away, width, words.data(), end).y + line() - em();
}

void Pen::fill(const DeskRect& rect, const ImVec4& colour, float rounding) const {
    if (draws_ && rect.width > 0 && rect.height > 0)
        list().AddRectFilled({rect.left, rect.top}, {rect.right(), rect.bottom()}, packed(colour),
                             rounding);
}

void Pen::outline(const DeskRect& rect, const ImVec4& colour, float thickness) const {
    if (draws_)
        list().AddRect({rect.left, rect.top}, {rect.right(), rect.bottom()}, packed(colour), 0, 0,
                       thickness);
}

void Pen::image(const DeskRect& rect, const Texture& texture) const {
    if (draws_)
        list().AddImage(ui_texture(texture), {rect.left, rect.top}, {rect.right(), rect.bottom()});
}

float Pen::mark(float x, float y, Mark mark) const {
    const float next = x + 1.1f * em();
    if (!draws_) return next;
    const float radius = 0.34f * em();
    const ImVec2 at(x + radius, y + 0.55f * em());
    const ImU32 colour = packed(colour_of(mark));
    switch (mark) {
        case Mark::good:
            list().AddCircleFilled(at, radius, colour);
            break;
        case Mark::care:
            list().AddTriangleFilled({at.x - 1.1f * radius, at.y + radius},
                                     {at.x + 1.1f * radius, at.y + radius},
                                     {at.x, at.y - 1.1f * radius}, colour);
            break;
        case Mark::bad:
            list().AddRectFilled({at.x - radius, at.y - radius}, {at.x + radius, at.y + radius},
                                 colour);
            break;
    }
    return next;
}

float Pen::badge(float x, float y, float height, std::string_view words,
                 const ImVec4& colour) const {
    const float inset = 0.5f * em(), width = width_of(words, true) + 2 * inset;
    fill({x, y, width, height}, colour, 0.2f * em());
    text(x + inset, y + 0.5f * (height - em()), palette::on_badge, words, true);
    return x + width + 0.5f * em();
}

Clipping::Clipping(const Pen& pen, const DeskRect& rect) : list_(&pen.list()) {
    list_->PushClipRect({rect.left, rect.top}, {rect.right(), rect.bottom()}, true);
}

Clipping::~Clipping() { list_->PopClipRect(); }

}  // namespace vantage
