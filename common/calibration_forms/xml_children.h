#pragma once

#include <string>
#include <vector>

#include "common/calibration_forms/form_tools.h"

namespace vantage {

/// All elements of this name within an element; a single one is no list in the tree.
std::vector<Tree> xml_children(const Tree& element, const std::string& name);

/// An attribute's text. Throws Error if it is missing.
std::string xml_attribute(const FormMap& element, const std::string& name);

/// An attribute as a number. Throws Error if it is missing, or is no finite number.
double xml_number(const FormMap& element, const std::string& name);

}  // namespace vantage
