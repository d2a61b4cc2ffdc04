#pragma once

#include <string_view>

#include <imgui.h>

#include "common/gl/objects/texture.h"
#include "host_app/desk/desk_arrangement.h"

namespace vantage {

/// The colours of the operator's desk. It is dark, so that the picture is the brightest part. The
/// hues can be told apart with impaired colour vision (M. Okabe and K. Ito, "Color universal
/// design", 2008) and are lightened for a dark background. A shape or a word repeats every colour.
namespace palette {
inline const ImVec4 text{0.90f, 0.92f, 0.94f, 1};
inline const ImVec4 dim{0.60f, 0.64f, 0.69f, 1};
inline const ImVec4 black{0, 0, 0, 1};
inline const ImVec4 ground{0.027f, 0.031f, 0.039f, 1};
inline const ImVec4 panel{0.067f, 0.078f, 0.094f, 1};
inline const ImVec4 line{0.27f, 0.31f, 0.36f, 1};
inline const ImVec4 accent{0.34f, 0.71f, 0.91f, 1};
inline const ImVec4 good{0.16f, 0.74f, 0.57f, 1};
inline const ImVec4 warn{0.95f, 0.80f, 0.25f, 1};
inline const ImVec4 bad{0.93f, 0.42f, 0.16f, 1};
inline const ImVec4 on_air{0.95f, 0.28f, 0.24f, 1};
inline const ImVec4 on_badge{0.03f, 0.03f, 0.04f, 1};
/// Laid over a picture that is out of date.
inline const ImVec4 veil{0.027f, 0.031f, 0.039f, 0.6f};
// The time line.
inline const ImVec4 trough{0.13f, 0.15f, 0.18f, 1};
inline const ImVec4 tick{0.30f, 0.34f, 0.40f, 1};
inline const ImVec4 between_marks{0.16f, 0.38f, 0.50f, 1};
// The stage's plan and 3-D view.
inline const ImVec4 field{0.55f, 0.60f, 0.66f, 0.30f};
inline const ImVec4 corridor{0.16f, 0.74f, 0.57f, 0.13f};
inline const ImVec4 corridor_edge{0.95f, 0.80f, 0.25f, 0.13f};
}  // namespace palette

/// Converts a colour for a draw list.
inline ImU32 packed(const ImVec4& colour) { return ImGui::GetColorU32(colour); }

struct UiFonts {
    ImFont* body = nullptr;
    ImFont* strong = nullptr;
};

/// A Dear ImGui context with the fonts of Vantage; it is current after construction. If DejaVu Sans
/// is not installed, ImGui's built-in font is used.
class UiContext {
  public:
    /// `letter_px` is the font height.
    explicit UiContext(float letter_px);
    ~UiContext();
    UiContext(const UiContext&) = delete;
    UiContext& operator=(const UiContext&) = delete;

    const UiFonts& fonts() const { return fonts_; }
    float letter_px() const { return letter_px_; }
    void make_current() const { ImGui::SetCurrentContext(context_); }
    /// Restores the current context at the end of its lifetime.
    class Kept {
      public:
        Kept() : context_(ImGui::GetCurrentContext()) {}
        ~Kept() { ImGui::SetCurrentContext(context_); }
        Kept(const Kept&) = delete;
        Kept& operator=(const Kept&) = delete;

      private:
        ImGuiContext* context_;
    };
    /// Reloads the fonts in this height. Call UiRenderer::take_fonts() afterwards.
    void set_letter_px(float letter_px);

  private:
    ImGuiContext* context_;
    UiFonts fonts_;
    float letter_px_ = 0;
};

/// A status mark with a shape as well as a colour: a disc, a triangle, a square.
enum class Mark { good, care, bad };
const ImVec4& colour_of(Mark mark);

/// Draws text and shapes on the desk, in the window's pixels. Its own lengths are in ems.
class Pen {
  public:
    explicit Pen(const UiFonts& fonts) : fonts_(&fonts) {}
    /// A pen that measures without drawing and returns the same values.
    Pen dry() const;

    float em() const { return fonts_->body->FontSize; }
    float line() const { return 1.32f * em(); }
    ImDrawList& list() const { return *ImGui::GetBackgroundDrawList(); }

    float width_of(std::string_view words, bool is_strong = false) const;
    /// Returns the x at which the text ends.
    float text(float x, float y, const ImVec4& colour, std::string_view words,
               bool is_strong = false) const;
    void text_right(float right, float y, const ImVec4& colour, std::string_view words,
                    bool is_strong = false) const;
    /// Shortens text that does not fit before `right` with an ellipsis.
    float text_until(float right, float x, float y, const ImVec4& colour, std::string_view words,
                     bool is_strong = false) const;
    /// Returns the height of the wrapped lines.
    float text_wrapped(float width, float x, float y, const ImVec4& colour,
                       std::string_view words) const;

    void fill(const DeskRect& rect, const ImVec4& colour, float rounding = 0) const;
    void outline(const DeskRect& rect, const ImVec4& colour, float thickness = 1) const;
    void image(const DeskRect& rect, const Texture& texture) const;
    /// Draws a mark of a line's height; returns the x at which text may follow.
    float mark(float x, float y, Mark mark) const;
    /// Draws a filled label such as LIVE in a row of this height; returns the x of the next one.
    float badge(float x, float y, float height, std::string_view words, const ImVec4& colour) const;

  private:
    void words_at(float x, float y, const ImVec4& colour, std::string_view words, bool is_strong,
                  float wrap_width = 0) const;
    ImFont* font(bool is_strong) const { return is_strong ? fonts_->strong : fonts_->body; }
    const UiFonts* fonts_;
    bool draws_ = true;
};

/// Clips all drawing to a rectangle during its lifetime.
class Clipping {
  public:
    Clipping(const Pen& pen, const DeskRect& rect);
    ~Clipping();
    Clipping(const Clipping&) = delete;
    Clipping& operator=(const Clipping&) = delete;

  private:
    ImDrawList* list_;
};

}  // namespace vantage
