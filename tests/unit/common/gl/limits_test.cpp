#include "common/gl/context/limits.h"

#include <string>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

TEST(GlInfo, DescribesTheContext) {
    const EglContext context;
    const GlInfo info = GlInfo::query();
    EXPECT_FALSE(info.renderer.empty());
    EXPECT_NE(info.version.find("OpenGL ES 3"), std::string::npos);
    EXPECT_GE(info.max_texture_side_px, 2048);
    EXPECT_GE(info.max_shared_bytes, PiLimits::max_shared_bytes);
}

TEST(GlInfo, LetsThreadsTakeTurnsAtOldSoftwareRenderers) {
    GlInfo info;
    info.is_software = true;
    const auto needs_turns = [&](const char* version) {
        info.version = version;
        return info.needs_turns();
    };
    EXPECT_TRUE(needs_turns("OpenGL ES 3.2 Mesa 22.3.6"));
    EXPECT_TRUE(needs_turns("OpenGL ES 3.2 Mesa 24.2.8-1ubuntu1"));
    EXPECT_FALSE(needs_turns("OpenGL ES 3.2 Mesa 25.0.7-2~bpo12+1"));
    EXPECT_TRUE(needs_turns("OpenGL ES 3.2 (another driver)"));
    EXPECT_TRUE(needs_turns(""));
    info.is_software = false;
    EXPECT_FALSE(needs_turns("OpenGL ES 3.1 Mesa 22.3.6")) << "a GPU's driver";
}

TEST(GlInfo, NamesACapabilityBelowTheMinimum) {
    GlInfo info;
    info.renderer = "Slate 1";
    info.max_texture_side_px = 4096;
    info.max_colour_targets = 4;
    info.max_workgroup_invocations = 256;
    info.max_shared_bytes = 16384;
    EXPECT_NO_THROW(info.require_vantage_minimum()) << "a Raspberry Pi";
    const auto refusal = [](const GlInfo& poor) {
        return thrown_sentence([&] { poor.require_vantage_minimum(); });
    };
    GlInfo poor = info;
    poor.max_colour_targets = 3;
    EXPECT_EQ(refusal(poor), "the GPU 'Slate 1' offers 3 colour targets, and Vantage needs 4");
    poor = info;
    poor.max_texture_side_px = 2048;
    EXPECT_NE(refusal(poor).find("2048 pixels of texture side"), std::string::npos);
    poor = info;
    poor.max_workgroup_invocations = 128;
    EXPECT_NE(refusal(poor).find("128 invocations"), std::string::npos);
    poor = info;
    poor.max_shared_bytes = 8192;
    EXPECT_NE(refusal(poor).find("8192 bytes"), std::string::npos);
}

TEST(CheckGl, TurnsAnErrorFlagIntoASentenceOnce) {
    const EglContext context;
    EXPECT_NO_THROW(check_gl("doing nothing"));
    glEnable(0xffff);
    EXPECT_EQ(thrown_sentence([] { check_gl("testing"); }),
              "OpenGL failed while testing: invalid enum");
    EXPECT_NO_THROW(check_gl("going on"));
}

TEST(GlExtensions, AreMatchedByTheirFullName) {
    const EglContext context;
    EXPECT_TRUE(has_gl_extension("GL_EXT_color_buffer_float"));
    EXPECT_FALSE(has_gl_extension("GL_EXT_color_buffer"));
}

}  // namespace
}  // namespace vantage
