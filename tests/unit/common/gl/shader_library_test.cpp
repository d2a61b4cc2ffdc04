#include "common/gl/shader_library.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/gl/shader_folder.h"

namespace vantage {
namespace {

TEST(ShaderLibrary, WritesVersionPrecisionAndDefinesBeforeTheFile) {
    const ShaderFolder folder;
    folder.write("a.frag", "// text\n");
    const ShaderLibrary library(folder.path());
    const std::string source = library.source("a.frag", {{"LANES", "16"}, {"WIDE", "1"}});
    EXPECT_TRUE(source.starts_with("#version 310 es\n"));
    EXPECT_NE(source.find("precision highp float;\n"), std::string::npos);
    EXPECT_TRUE(source.ends_with("#define LANES 16\n#define WIDE 1\n#line 1\n// text\n"));
}

TEST(ShaderLibrary, PutsIncludesInPlaceAndKeepsLineNumbers) {
    const ShaderFolder folder;
    folder.write("a.frag", "first\n  #include \"b.glsl\"\nthird\n");
    folder.write("b.glsl", "#include \"c.glsl\"\nb two\n");
    folder.write("c.glsl", "c one\n");
    const std::string source = ShaderLibrary(folder.path()).source("a.frag");
    EXPECT_TRUE(
        source.ends_with("#line 1\nfirst\n#line 1\n#line 1\nc one\n#line 2\nb two\n#line 3\n"
                         "third\n"))
        << source;
}

TEST(ShaderLibrary, RefusesUnknownFilesAndEndlessIncludes) {
    const ShaderFolder folder;
    folder.write("a.glsl", "#include \"b.glsl\"\n");
    folder.write("b.glsl", "#include \"a.glsl\"\n");
    folder.write("c.glsl", "#include \"missing.glsl\"\n");
    const ShaderLibrary library(folder.path());
    EXPECT_NE(thrown_sentence([&] { library.source("a.glsl"); }).find("deeper than 8"),
              std::string::npos);
    EXPECT_EQ(thrown_sentence([&] { library.source("c.glsl"); }),
              "there is no shader named missing.glsl");
}

TEST(ShaderLibrary, HoldsEveryShaderInTheProgram) {
    const ShaderLibrary library{std::filesystem::path()};
    const auto names = library.embedded_names();
    EXPECT_NE(std::find(names.begin(), names.end(), "fullscreen.vert"), names.end());
    EXPECT_NE(library.source("fullscreen.vert").find("gl_Position"), std::string::npos);
}

TEST(ShaderLibrary, AFileInTheFolderWinsOverTheEmbeddedOne) {
    const ShaderFolder folder;
    folder.write("fullscreen.vert", "// mine\n");
    const ShaderLibrary library(folder.path());
    EXPECT_NE(library.source("fullscreen.vert").find("// mine"), std::string::npos);
    // Others still come from the program.
    const auto names = library.embedded_names();
    const auto other = std::find_if(names.begin(), names.end(),
                                    [](const auto& name) { return name != "fullscreen.vert"; });
    ASSERT_NE(other, names.end());
    EXPECT_NO_THROW(library.source(*other));
}

TEST(ShaderLibrary, TheEnvironmentNamesTheFolder) {
    const ShaderFolder folder;
    folder.write("mine.comp", "// mine\n");
    setenv("VANTAGE_SHADERS", folder.path().c_str(), 1);
    const ShaderLibrary library;
    setenv("VANTAGE_SHADERS", (folder.path() / "gone").c_str(), 1);
    const std::string refusal = thrown_sentence([] { const ShaderLibrary none; });
    unsetenv("VANTAGE_SHADERS");
    EXPECT_NO_THROW(library.source("mine.comp"));
    EXPECT_NE(refusal.find("gone (from VANTAGE_SHADERS) does not exist"), std::string::npos);
    EXPECT_EQ(thrown_sentence([] { ShaderLibrary().source("mine.comp"); }),
              "there is no shader named mine.comp");
}

TEST(ShaderLibrary, NoticesEditsNewFilesAndNothingElse) {
    const ShaderFolder folder;
    folder.write("a.frag", "one\n");
    ShaderLibrary library(folder.path());
    EXPECT_FALSE(library.poll());
    EXPECT_EQ(library.generation(), 0u);
    folder.write("a.frag", "two\n");
    EXPECT_TRUE(library.poll());
    EXPECT_EQ(library.generation(), 1u);
    EXPECT_FALSE(library.poll()) << "once for each change";
    EXPECT_NE(library.source("a.frag").find("two"), std::string::npos);
    folder.write("b.frag", "new\n");
    EXPECT_TRUE(library.poll());
    EXPECT_EQ(library.generation(), 2u);
}

TEST(ShaderLibrary, WithoutAFolderNothingEverChanges) {
    ShaderLibrary library{std::filesystem::path()};
    EXPECT_FALSE(library.poll());
    EXPECT_EQ(library.generation(), 0u);
}

}  // namespace
}  // namespace vantage
