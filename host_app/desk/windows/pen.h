#pragma once

#include <string_view>

#include <imgui.h>

#include "common/gl/objects/texture.h"
#include "host_app/desk/desk_layout.h"
#include "host_app/desk/windows/style.h"

namespace vantage {

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
