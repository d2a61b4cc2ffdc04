#include "common/gl/context/egl_context.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <thread>
#include <utility>

#include <GLES3/gl31.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/gl/objects/texture.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

auto used(const EglContext& context) {
    return std::ranges::count(context.attempts(), "ok", &EglAttempt::outcome);
}

TEST(EglContext, ReportsEveryAttemptAndWhichOneIsUsed) {
    const EglContext context;
    ASSERT_FALSE(context.attempts().empty());
    EXPECT_EQ(context.attempts().front().platform, "surfaceless") << "tried first";
    for (const EglAttempt& attempt : context.attempts()) {
        EXPECT_FALSE(attempt.platform.empty());
        EXPECT_FALSE(attempt.outcome.empty()) << attempt.platform;
    }
    EXPECT_EQ(used(context), 1);
}

TEST(EglContext, IsCurrentAndOpenGlEs31) {
    const EglContext context;
    EXPECT_NE(eglGetCurrentContext(), EGL_NO_CONTEXT);
    EXPECT_EQ(eglGetCurrentDisplay(), context.display());
    GLint major = 0, minor = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    EXPECT_GE(10 * major + minor, 31);
}

TEST(EglContext, CanBeCreatedAgain) {
    { const EglContext first; }
    EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
    const EglContext second;
    EXPECT_EQ(used(second), 1);
    EXPECT_NE(eglGetCurrentContext(), EGL_NO_CONTEXT);
}

TEST(EglContext, OutlivesAnotherOneOfTheProcess) {
    const EglContext first;
    { const EglContext second; }
    EXPECT_TRUE(first.has_extension("EGL_KHR_surfaceless_context"))
        << "the other one took the display along";
}

TEST(EglContext, SharesObjectsWithOneThatIsCurrentElsewhere) {
    const EglContext first;
    const Texture texture(TextureFormat::r8, 3, 2);
    const EglContext second = EglContext::sharing_with(first);
    EXPECT_EQ(second.display(), first.display());
    const EGLContext of_first = eglGetCurrentContext();
    std::thread([&] {
        EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
        {
            const CurrentContext current(second);
            EXPECT_NE(eglGetCurrentContext(), EGL_NO_CONTEXT);
            EXPECT_TRUE(glIsTexture(texture.name()));
        }
        EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
    }).join();
    EXPECT_EQ(eglGetCurrentContext(), of_first) << "this thread keeps its own";
}

TEST(EglContext, SharedObjectsOutliveTheFirst) {
    std::optional<EglContext> first(std::in_place);
    const Texture texture(TextureFormat::r8, 3, 2);
    const EglContext second = EglContext::sharing_with(*first);
    first.reset();
    const CurrentContext current(second);
    EXPECT_TRUE(glIsTexture(texture.name()));
}

TEST(EglContext, RestoresThePreviousContext) {
    const EglContext first;
    const EGLContext of_first = eglGetCurrentContext();
    const EglContext second = EglContext::sharing_with(first);
    {
        const CurrentContext current(second);
        EXPECT_NE(eglGetCurrentContext(), of_first);
    }
    EXPECT_EQ(eglGetCurrentContext(), of_first);
}

TEST(EglContext, IsCurrentOnOneThreadOnly) {
    const EglContext context;
    std::thread([&] {
        EXPECT_EQ(thrown_sentence([&] { const CurrentContext current(context); }),
                  "an OpenGL context cannot be made current on this thread (EGL_BAD_ACCESS)");
    }).join();
}

TEST(EglContext, MatchesExtensionsByTheirFullName) {
    const EglContext context;
    EXPECT_TRUE(context.has_extension("EGL_KHR_surfaceless_context"));
    EXPECT_FALSE(context.has_extension("EGL_KHR_surfaceless"));
    EXPECT_FALSE(context.has_extension("EGL_VANTAGE_magic"));
}

/// In a process of its own, since EGL looks for its drivers once.
[[noreturn]] void open_a_context_without_drivers() {
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere", 1);
    setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nowhere", 1);
    try {
        const EglContext context;
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        std::exit(1);
    }
    std::exit(0);
}

TEST(EglContextDeathTest, ListsAllAttemptsWithoutADriver) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(open_a_context_without_drivers(), testing::ExitedWithCode(1),
                "no OpenGL ES 3.1 without a display.*; surfaceless: .*; device.*: .*; gbm.*: ");
}

}  // namespace
}  // namespace vantage
