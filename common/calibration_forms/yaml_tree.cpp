#include <algorithm>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/calibration_forms/text_tree.h"

namespace vantage {
namespace {

constexpr int deepest = 40;

struct YamlLine {
    int number = 0;
    std::size_t indent = 0;
    std::string text;  ///< without indent, comment and blanks at its end
};

/// The text before a comment; '#' begins one at the start or after a blank, outside quotes.
std::string_view before_comment(std::string_view line) {
    char quote = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (quote != 0) {
            if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '#' && (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t')) {
            return line.substr(0, i);
        }
    }
    return line;
}

std::string trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::vector<YamlLine> yaml_lines(const std::string& text) {
    std::vector<YamlLine> lines;
    int number = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view whole(text.data() + at, end - at);
        at = end + 1;
        ++number;
        const std::string_view line = before_comment(whole);
        const std::string content = trimmed(line);
        if (content.empty() || (lines.empty() && content[0] == '%')) continue;
        if (content == "---" || content == "...") continue;
        lines.push_back({number, line.find_first_not_of(" \t"), content});
    }
    return lines;
}

/// Where the ':' after a key stands; npos: the text is no entry of a map. OpenCV writes and reads
/// "key:[" too.
std::size_t colon_of(std::string_view text) {
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quote != 0) {
            if (c == quote) quote = 0;
            continue;
        }
        if (c == '"' || c == '\'') quote = c;
        if (i == 0 && (c == '[' || c == '{')) return std::string_view::npos;
        if (c == ':' && (i + 1 == text.size() || text[i + 1] == ' ' || text[i + 1] == '\t' ||
                         text[i + 1] == '[' || text[i + 1] == '{'))
            return i;
    }
    return std::string_view::npos;
}

std::string unquoted(const std::string& text) {
    if (text.size() > 1 && (text[0] == '"' || text[0] == '\'') && text.back() == text[0])
        return text.substr(1, text.size() - 2);
    return text;
}

Tree yaml_scalar(const std::string& text) {
    const std::string inner = unquoted(text);
    return inner.size() == text.size() ? scalar_tree(text) : Tree(inner);
}

/// "[1, 2]", "{a: 1}": lists and maps between brackets.
class FlowParser {
  public:
    FlowParser(std::string_view text, int line) : text_(text), line_(line) {}

    Tree parse() {
        Tree tree = value(0);
        skip_blanks();
        if (at_ < text_.size()) damaged("something stands after the closing bracket");
        return tree;
    }

  private:
    [[noreturn]] void damaged(const char* what) const { fail("line {}: {}", line_, what); }
    void skip_blanks() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    }
    char next() {
        skip_blanks();
        if (at_ >= text_.size()) damaged("a bracket is not closed");
        return text_[at_];
    }
    std::string scalar(bool is_key) {
        const std::size_t begin = at_;
        if (const char quote = text_[at_]; quote == '"' || quote == '\'') {
            const std::size_t end = text_.find(quote, at_ + 1);
            if (end == std::string_view::npos) damaged("a quote is not closed");
            at_ = end + 1;
            return std::string(text_.substr(begin, at_ - begin));
        }
        while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != ']' && text_[at_] != '}' &&
               !(is_key && text_[at_] == ':'))
            ++at_;
        return trimmed(text_.substr(begin, at_ - begin));
    }
    Tree value(int depth) {
        if (depth > deepest) damaged("lists stand too deep within each other");
        if (next() == '[') return list(depth);
        if (next() == '{') return map(depth);
        return yaml_scalar(scalar(false));
    }
    Tree list(int depth) {
        Tree tree = Tree::array();
        ++at_;
        while (next() != ']') {
            tree.push_back(value(depth + 1));
            if (next() == ',')
                ++at_;
            else if (next() != ']')
                damaged("a ',' is missing in a list");
        }
        ++at_;
        return tree;
    }
    Tree map(int depth) {
        Tree tree = Tree::object();
        ++at_;
        while (next() != '}') {
            const std::string key = unquoted(scalar(true));
            if (next() != ':') damaged("a ':' is missing in a map");
            ++at_;
            tree[key] = value(depth + 1);
            if (next() == ',')
                ++at_;
            else if (next() != '}')
                damaged("a ',' is missing in a map");
        }
        ++at_;
        return tree;
    }

    std::string_view text_;
    int line_;
    std::size_t at_ = 0;
};

class YamlParser {
  public:
    explicit YamlParser(const std::string& text) : lines_(yaml_lines(text)) {}

    Tree parse() {
        if (lines_.empty()) fail("it is empty");
        Tree tree = block(lines_.front().indent, 0);
        if (at_ < lines_.size())
            damaged("the indentation of this line differs from the lines before it");
        return tree;
    }

  private:
    [[noreturn]] void damaged(const char* what) const {
        fail("line {}: {}", lines_[std::min(at_, lines_.size() - 1)].number, what);
    }
    static bool is_item(const YamlLine& line) {
        return line.text == "-" || line.text.starts_with("- ");
    }
    bool is_block_at(std::size_t indent) const {
        return at_ < lines_.size() && lines_[at_].indent == indent;
    }

    Tree block(std::size_t indent, int depth) {
        if (depth > deepest) damaged("maps stand too deep within each other");
        return is_item(lines_[at_]) ? items(indent, depth) : entries(indent, depth);
    }
    Tree items(std::size_t indent, int depth) {
        Tree list = Tree::array();
        while (is_block_at(indent) && is_item(lines_[at_])) {
            YamlLine& line = lines_[at_];
            const std::size_t begin = line.text.find_first_not_of(" \t", 1);
            if (begin == std::string::npos) {
                ++at_;
                list.push_back(below(indent, depth, false));
                continue;
            }
            line.indent += begin;
            line.text.erase(0, begin);
            const bool is_nested = is_item(line) || colon_of(line.text) != std::string::npos;
            list.push_back(is_nested ? block(line.indent, depth + 1) : rest_of_line(line.text));
        }
        return list;
    }
    Tree entries(std::size_t indent, int depth) {
        Tree map = Tree::object();
        while (is_block_at(indent) && !is_item(lines_[at_])) {
            const YamlLine& line = lines_[at_];
            const std::size_t colon = colon_of(line.text);
            if (colon == std::string::npos) damaged("this is no 'key: value'");
            const std::string key = unquoted(trimmed(line.text.substr(0, colon)));
            std::string value = trimmed(line.text.substr(colon + 1));
            // Tags and anchors do not change the values.
            while (!value.empty() && (value[0] == '!' || value[0] == '&')) {
                const std::size_t end = value.find_first_of(" \t");
                value = end == std::string::npos ? "" : trimmed(value.substr(end));
            }
            if (value.empty()) {
                ++at_;
                map[key] = below(indent, depth, true);
            } else if (value[0] == '|' || value[0] == '>') {
                map[key] = text_below(indent);
            } else {
                map[key] = rest_of_line(value);
            }
        }
        return map;
    }
    /// Parses the value of a key or an item whose value begins on the next line.
    Tree below(std::size_t indent, int depth, bool may_be_items_beside) {
        if (at_ >= lines_.size()) return nullptr;
        const YamlLine& line = lines_[at_];
        if (line.indent > indent || (may_be_items_beside && line.indent == indent && is_item(line)))
            return block(line.indent, depth + 1);
        return nullptr;
    }
    Tree text_below(std::size_t indent) {
        std::string text;
        for (++at_; at_ < lines_.size() && lines_[at_].indent > indent; ++at_)
            text += lines_[at_].text + '\n';
        return text;
    }
    /// A scalar, or brackets, which may go on over the next lines.
    Tree rest_of_line(std::string value) {
        const int number = lines_[at_].number;
        ++at_;
        if (value[0] != '[' && value[0] != '{') return yaml_scalar(value);
        constexpr std::size_t most_lines = 2000;
        for (const std::size_t first = at_; is_open(value);) {
            if (at_ >= lines_.size() || at_ - first > most_lines)
                fail("line {}: a bracket is not closed", number);
            value += ' ' + lines_[at_++].text;
        }
        return FlowParser(value, number).parse();
    }
    static bool is_open(std::string_view text) {
        int depth = 0;
        char quote = 0;
        for (const char c : text) {
            if (quote != 0) {
                if (c == quote) quote = 0;
            } else if (c == '"' || c == '\'') {
                quote = c;
            } else {
                depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
            }
        }
        return depth > 0 || quote != 0;
    }

    std::vector<YamlLine> lines_;
    std::size_t at_ = 0;
};

}  // namespace

Tree parse_yaml_tree(const std::string& text) { return YamlParser(text).parse(); }

}  // namespace vantage
