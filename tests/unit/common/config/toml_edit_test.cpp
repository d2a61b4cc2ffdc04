#include "common/config/toml_edit.h"

#include <gtest/gtest.h>
#include <toml++/toml.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

constexpr const char* text = R"(# år: what comes first
version = 1   # of the form

[axes.jog]    # the wheel
action = "wheel" # turns
sensitivity = 1.0

[buttons]
"b 1" = "mode"
[[rigs]]
name = "a"
)";

std::string set(const std::string& in, const char* table, const char* key, const char* value) {
    return with_toml_value(in, table, key, value, "file.toml");
}

TEST(TomlEdit, ReplacesAValueAndKeepsTheRest) {
    std::string expected = text;
    expected.replace(expected.find("\"wheel\""), 7, "\"orbit\"");
    EXPECT_EQ(set(text, "axes.jog", "action", "\"orbit\""), expected);
    expected = text;
    expected.replace(expected.find("\"mode\""), 6, "\"live\"");
    EXPECT_EQ(set(text, "buttons", "b 1", "\"live\""), expected);
    expected = text;
    expected.replace(expected.find("1   #"), 1, "22");
    EXPECT_EQ(set(text, "", "version", "22"), expected);
}

TEST(TomlEdit, CountsCharactersOfMoreThanOneByteInALine) {
    EXPECT_EQ(set("a = {z = \"öåü\", b = 1} # ü\n", "a", "b", "2"),
              "a = {z = \"öåü\", b = 2} # ü\n");
}

TEST(TomlEdit, PutsANewKeyBelowItsHeader) {
    std::string expected = text;
    expected.insert(expected.find("action"), "dead_zone = 0.1\n");
    EXPECT_EQ(set(text, "axes.jog", "dead_zone", "0.1"), expected);
    expected = text;
    expected.insert(expected.find("\n[axes"), "key_file = \"k\"\n");
    EXPECT_EQ(set(text, "", "key_file", "\"k\""), expected);
    EXPECT_EQ(set("version = 1", "", "b", "2"), "version = 1\nb = 2\n");
}

TEST(TomlEdit, WritesAMissingTableAtTheEnd) {
    const std::string edited = set(text, "axes.ring", "action", "\"shuttle\"");
    EXPECT_EQ(edited, std::string(text) + "\n[axes.ring]\naction = \"shuttle\"\n");
    EXPECT_EQ(toml::parse(edited).at_path("axes.ring.action").value_or(std::string()), "shuttle");
}

TEST(TomlEdit, RemovesAKeyWithItsLine) {
    std::string expected = text;
    expected.erase(expected.find("sensitivity"), 18);
    EXPECT_EQ(without_toml_key(text, "axes.jog", "sensitivity", "f"), expected);
    EXPECT_EQ(without_toml_key(text, "axes.jog", "none", "f"), text);
}

TEST(TomlEdit, RefusesTablesWithoutAHeader) {
    EXPECT_NE(thrown_sentence([] { (void)set(text, "rigs", "b", "1"); }).find("is not a table"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([] { (void)set("a.b = 1\n", "a", "c", "1"); }).find("header [a]"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([] { (void)set("=", "a", "c", "1"); }).find("is not TOML"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
