#include "common/calibration_forms/xml_children.h"

#include <cmath>

namespace vantage {

std::vector<Tree> xml_children(const Tree& element, const std::string& name) {
    if (!element.is_object() || !element.contains(name)) return {};
    const Tree& found = element[name];
    if (found.is_object()) return {found};
    std::vector<Tree> children;
    if (found.is_array())
        for (const Tree& child : found)
            if (child.is_object()) children.push_back(child);
    return children;
}

std::string xml_attribute(const FormMap& element, const std::string& name) {
    return element.text("@" + name);
}

double xml_number(const FormMap& element, const std::string& name) {
    const std::string text = xml_attribute(element, name);
    const Tree value = scalar_tree(text);
    if (!value.is_number() || !std::isfinite(value.get<double>()))
        fail("{}: '{}' is '{}', and must be a number", element.where, name, text);
    return value.get<double>();
}

}  // namespace vantage
