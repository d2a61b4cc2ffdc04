#include <algorithm>
#include <sstream>
#include <string_view>

#include "common/base/error.h"
#include "common/calibration_forms/text_tree.h"

namespace vantage {
namespace {

constexpr int deepest_element = 40;
constexpr std::string_view xml_blanks = " \t\r\n";

/// Elements, their attributes and text; neither entities of its own nor namespaces.
class XmlParser {
  public:
    explicit XmlParser(std::string_view text) : text_(text) {}

    /// Parses the content of the outermost element, under its name.
    Tree parse() {
        skip_prologue();
        Tree tree = Tree::object();
        std::string name;
        Tree content = element(name, 0);
        tree[name] = std::move(content);
        return tree;
    }

  private:
    [[noreturn]] void damaged(const char* what) const {
        const auto line = 1 + std::count(text_.begin(), text_.begin() + at_signed(), '\n');
        fail("line {}: {}", line, what);
    }
    std::ptrdiff_t at_signed() const {
        return static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
    }
    bool starts(std::string_view what) const { return text_.substr(at_).starts_with(what); }
    void skip_blanks() { at_ = std::min(text_.find_first_not_of(xml_blanks, at_), text_.size()); }
    void skip_to(std::string_view end) {
        const std::size_t found = text_.find(end, at_);
        if (found == std::string_view::npos) damaged("the file ends within a comment or tag");
        at_ = found + end.size();
    }
    void skip_prologue() {
        for (skip_blanks(); starts("<?") || starts("<!"); skip_blanks())
            skip_to(starts("<!--") ? "-->" : ">");
    }
    std::string name() {
        const std::size_t end = text_.find_first_of(" \t\r\n/>=", at_);
        if (end == std::string_view::npos || end == at_) damaged("a name is missing");
        const std::string found(text_.substr(at_, end - at_));
        at_ = end;
        return found;
    }
    void attributes(Tree& tree) {
        for (skip_blanks(); at_ < text_.size() && text_[at_] != '>' && text_[at_] != '/';
             skip_blanks()) {
            const std::string key = name();
            skip_blanks();
            if (!starts("=")) damaged("an attribute has no value");
            ++at_;
            skip_blanks();
            const char quote = at_ < text_.size() ? text_[at_] : ' ';
            if (quote != '"' && quote != '\'') damaged("an attribute is not quoted");
            const std::size_t begin = ++at_;
            skip_to(std::string_view(&quote, 1));
            tree["@" + key] = std::string(text_.substr(begin, at_ - 1 - begin));
        }
    }
    Tree element(std::string& tag, int depth) {
        if (depth > deepest_element) damaged("elements stand too deep within each other");
        if (!starts("<")) damaged("an element is missing");
        ++at_;
        tag = name();
        Tree map = Tree::object(), list = Tree::array();
        attributes(map);
        if (starts("/>")) {
            at_ += 2;
            return map;
        }
        if (!starts(">")) damaged("a tag is not closed");
        ++at_;
        std::string text;
        bool has_children = false;
        for (;;) {
            const std::size_t end = text_.find('<', at_);
            if (end == std::string_view::npos) damaged("an element is not closed");
            text += text_.substr(at_, end - at_);
            at_ = end;
            if (starts("<!--")) {
                skip_to("-->");
            } else if (starts("</")) {
                at_ += 2;
                if (name() != tag) damaged("an element is closed under another name");
                skip_blanks();
                if (!starts(">")) damaged("a tag is not closed");
                ++at_;
                break;
            } else {
                has_children = true;
                std::string child;
                Tree content = element(child, depth + 1);
                if (child == "_") {
                    list.push_back(std::move(content));
                } else if (map.contains(child)) {
                    // Elements of one name are a list.
                    if (!map[child].is_array() || !map[child].front().is_object())
                        map[child] = Tree::array({map[child]});
                    map[child].push_back(std::move(content));
                } else {
                    map[child] = std::move(content);
                }
            }
        }
        if (!list.empty()) return list;
        return has_children ? map : leaf(text, map);
    }
    static Tree leaf(const std::string& text, const Tree& attributes) {
        std::istringstream words(text);
        Tree values = Tree::array();
        bool are_numbers = true;
        for (std::string word; words >> word;) {
            values.push_back(scalar_tree(word));
            are_numbers = are_numbers && values.back().is_number();
        }
        if (values.size() > 1 && are_numbers) return values;
        if (values.size() == 1 && are_numbers) return values.front();
        std::string whole = text;
        whole.erase(0, std::min(whole.find_first_not_of(xml_blanks), whole.size()));
        whole.erase(whole.find_last_not_of(xml_blanks) + 1);
        if (whole.size() > 1 && whole.front() == '"' && whole.back() == '"')
            whole = whole.substr(1, whole.size() - 2);
        if (whole.empty() && !attributes.empty()) return attributes;
        return whole;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace

Tree parse_xml_tree(const std::string& text) { return XmlParser(text).parse(); }

}  // namespace vantage
