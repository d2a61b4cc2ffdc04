#include "calib_tools/plots/html_page.h"

#include <span>

#include <fmt/format.h>

#include "common/base/files/atomic_file.h"

namespace vantage {
namespace {

constexpr std::string_view style = R"(
body{font:15px/1.5 system-ui,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;color:#1c2430;background:#fff}
h1{font-size:1.6rem}h2{font-size:1.15rem;margin-top:2rem;border-bottom:1px solid #d5dbe3;padding-bottom:.2rem}
table{border-collapse:collapse}th,td{padding:.25rem .8rem;text-align:left;border-bottom:1px solid #e4e8ee}
th{font-weight:600;color:#586475}td{font-variant-numeric:tabular-nums}
.good{color:#137a3b;font-weight:600}.warn{color:#a86300;font-weight:600}.bad{color:#c0202b;font-weight:600}
figure{display:inline-block;margin:.6rem 1rem .6rem 0;vertical-align:top}figcaption{color:#586475;font-size:.85rem;max-width:28rem}
svg{background:#fbfcfd;border:1px solid #d5dbe3;font:11px system-ui,sans-serif}
)";

std::string class_of(std::string_view mark) {
    return mark.empty() ? "" : fmt::format(" class=\"{}\"", mark);
}

}  // namespace

std::string_view mark_of(double value, double warn_at, double bad_at) {
    return value < warn_at ? "good" : value < bad_at ? "warn" : "bad";
}

std::string escape_markup(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            default:
                escaped += c;
        }
    }
    return escaped;
}

HtmlPage::HtmlPage(std::string_view title) : title_(escape_markup(title)) {}

void HtmlPage::heading(std::string_view text) {
    body_ += fmt::format("<h2>{}</h2>\n", escape_markup(text));
}

void HtmlPage::paragraph(std::string_view text, std::string_view mark) {
    body_ += fmt::format("<p{}>{}</p>\n", class_of(mark), escape_markup(text));
}

void HtmlPage::list(const std::vector<std::string>& sentences) {
    body_ += "<ul>\n";
    for (const std::string& sentence : sentences)
        body_ += fmt::format("<li>{}</li>\n", escape_markup(sentence));
    body_ += "</ul>\n";
}

void HtmlPage::table(const std::vector<std::string>& columns,
                     const std::vector<std::vector<Cell>>& rows) {
    body_ += "<table><tr>";
    for (const std::string& column : columns)
        body_ += fmt::format("<th>{}</th>", escape_markup(column));
    body_ += "</tr>\n";
    for (const std::vector<Cell>& row : rows) {
        body_ += "<tr>";
        for (const Cell& cell : row)
            body_ += fmt::format("<td{}>{}</td>", class_of(cell.mark), escape_markup(cell.text));
        body_ += "</tr>\n";
    }
    body_ += "</table>\n";
}

void HtmlPage::figure(const std::string& svg, std::string_view caption) {
    body_ += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", svg,
                         escape_markup(caption));
}

std::string HtmlPage::text() const {
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>"
        "<style>{1}</style></head>\n<body><h1>{0}</h1>\n{2}</body></html>\n",
        title_, style, body_);
}

void HtmlPage::save(const std::filesystem::path& path) const {
    const std::string page = text();
    write_file_atomically(path, std::as_bytes(std::span(page)));
}

}  // namespace vantage
