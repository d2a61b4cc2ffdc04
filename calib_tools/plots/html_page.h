#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Self-contained HTML page with inline styles and drawings. Texts are escaped.
class HtmlPage {
  public:
    explicit HtmlPage(std::string_view title);

    struct Cell {
        std::string text;
        std::string_view mark = {};  ///< colour: "good", "warn" or "bad"; empty: plain
    };

    void heading(std::string_view text);
    void paragraph(std::string_view text, std::string_view mark = {});
    void list(const std::vector<std::string>& sentences);
    void table(const std::vector<std::string>& columns, const std::vector<std::vector<Cell>>& rows);
    /// `svg` is inserted unescaped.
    void figure(const std::string& svg, std::string_view caption);

    std::string text() const;
    /// Writes the page atomically. Throws Error.
    void save(const std::filesystem::path& path) const;

  private:
    std::string title_, body_;
};

/// Mark of a value for which smaller is better.
std::string_view mark_of(double value, double warn_at, double bad_at);

/// Escapes &, <, > and quotes for HTML and XML.
std::string escape_markup(std::string_view text);

}  // namespace vantage
