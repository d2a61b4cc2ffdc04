#pragma once

#include <string_view>

#include <imgui.h>

#include "common/gl/objects/texture.h"
#include "host_app/desk/desk_layout.h"
#include "host_app/desk/windows/style.h"

namespace vantage {

/// How something stands, told by shape as well as by colour: a disc, a triangle, a square.
enum class Mark { good, care, bad };
const ImVec4& colour_of(Mark mark);

/// Draws onto the desk, in the window's pixels. Lengths of its own are in ems.
class Pen {
  public:
    explicit Pen(const UiFonts& fonts) : fonts_(&fonts) {}
    /// One that only measures: it draws nothing and returns the same.
    Pen dry() const;

    float em() const { return fonts_->body->FontSize; }
    float line() const { return 1.32f * em(); }
    ImDrawList& list() const { return *ImGui::GetBackgroundDrawList(); }

    float width_of(std::string_view words, bool is_strong = false) const;
    /// Returns where the words end.
    float text(float x, float y, const ImVec4& colour, std::string_view words,
               bool is_strong = false) const;
    void text_right(float right, float y, const ImVec4& colour, std::string_view words,
                    bool is_strong = false) const;
    /// What does not fit before `right` gives way to an ellipsis.
    float text_until(float right, float x, float y, const ImVec4& colour, std::string_view words,
                     bool is_strong = false) const;
    /// Returns the height that the lines took.
    float text_wrapped(float width, float x, float y, const ImVec4& colour,
                       std::string_view words) const;

    void fill(const DeskRect& rect, const ImVec4& colour, float rounding = 0) const;
    void outline(const DeskRect& rect, const ImVec4& colour, float thickness = 1) const;
    void image(const DeskRect& rect, const Texture& texture) const;
    /// Of a line's height; returns where words go on.
    float mark(float x, float y, Mark mark) const;
    /// A filled label such as LIVE, in a row of this height; returns where the next one begins.
    float badge(float x, float y, float height, std::string_view words, const ImVec4& colour) const;

  private:
    void words_at(float x, float y, const ImVec4& colour, std::string_view words, bool is_strong,
                  float wrap_width = 0) const;
    ImFont* font(bool is_strong) const { return is_strong ? fonts_->strong : fonts_->body; }
    const UiFonts* fonts_;
    bool draws_ = true;
};

/// Nothing outside the rectangle is drawn while it lives.
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
