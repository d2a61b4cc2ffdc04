#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace vantage {

/// A structured text file as maps, lists, numbers and texts; maps keep the order of the file.
using Tree = nlohmann::ordered_json;

/// Parses JSON, XML, TOML (by the extension .toml) or YAML. Of YAML the part that calibrations use:
/// block and flow maps and lists, quoted texts, comments; tags and anchors are passed over. Of XML
/// elements with their text, attributes as "@name"; lists are elements named "_" or numbers between
/// spaces. Throws Error, with the line where one is known, for what is damaged.
Tree parse_text_tree(const std::string& text, const std::filesystem::path& path);

Tree parse_yaml_tree(const std::string& text);
Tree parse_xml_tree(const std::string& text);

/// A scalar's text as a number where it is one, else as a text.
Tree scalar_tree(const std::string& text);

}  // namespace vantage
