#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// A page that needs nothing beside itself: styles inside, drawings inline. Texts are escaped.
class HtmlPage {
  public:
    explicit HtmlPage(std::string_view title);

    struct Cell {
        std::string text;
        std::string_view mark = {};  ///< "good", "warn", "bad": coloured so; empty: plain
    };

    void heading(std::string_view text);
    void paragraph(std::string_view text, std::string_view mark = {});
    void list(const std::vector<std::string>& sentences);
    void table(const std::vector<std::string>& columns, const std::vector<std::vector<Cell>>& rows);
    /// `svg` stands as it is.
    void figure(const std::string& svg, std::string_view caption);

    std::string text() const;
    /// Written whole or not at all. Throws Error.
    void save(const std::filesystem::path& path) const;

  private:
    std::string title_, body_;
};

/// The mark of a value that is better the smaller it is.
std::string_view mark_of(double value, double warn_at, double bad_at);

/// With &, <, > and quotes written as HTML and XML want them.
std::string escape_markup(std::string_view text);

}  // namespace vantage
