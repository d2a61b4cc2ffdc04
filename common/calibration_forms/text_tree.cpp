#include "common/calibration_forms/text_tree.h"

#include <limits>
#include <sstream>

#include <toml++/toml.h>

#include "common/base/error.h"

namespace vantage {
namespace {

constexpr const char* blanks = " \t\r\n";

std::string without_blanks_around(const std::string& text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

Tree parse_toml_tree(const std::string& text) {
    try {
        const toml::table table = toml::parse(text);
        std::ostringstream json;
        json << toml::json_formatter(table);
        return Tree::parse(json.str());
    } catch (const toml::parse_error& error) {
        fail("it is not TOML (line {}): {}", error.source().begin.line, error.description());
    } catch (const Tree::exception&) {
        fail("it holds a number that is not finite");
    }
}

Tree parse_json_tree(const std::string& text) {
    try {
        return Tree::parse(text);
    } catch (const Tree::parse_error& error) {
        fail("it is not JSON (near byte {})", error.byte);
    } catch (const Tree::exception&) {
        fail("it holds a number beyond what a double can hold");
    }
}

}  // namespace

Tree scalar_tree(const std::string& text) {
    std::istringstream words(text);
    words.imbue(std::locale::classic());
    double number = 0;
    if (!text.empty() && words >> number && words.peek() == std::char_traits<char>::eof())
        return number;
    if (text == ".Nan" || text == ".nan" || text == ".NaN")
        return std::numeric_limits<double>::quiet_NaN();
    return text;
}

Tree parse_text_tree(const std::string& text, const std::filesystem::path& path) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string::npos) fail("it is empty");
    if (path.extension() == ".toml") return parse_toml_tree(without_blanks_around(text));
    if (text[first] == '<') return parse_xml_tree(text);
    if (text[first] == '{' || text[first] == '[') return parse_json_tree(text);
    return parse_yaml_tree(text);
}

}  // namespace vantage
