#include "host_app/desk/windows/gl_window.h"

#include <cstdlib>
#include <optional>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "common/gl/context/limits.h"
#include "host_app/desk/windows/operator_window.h"
#include "tests/support/virtual_screen.h"

namespace vantage {
namespace {

class GlWindow : public testing::Test {
  protected:
    void SetUp() override {
        if (!VirtualScreen::is_there()) GTEST_SKIP() << "SKIPPED: Xvfb or xdotool is not installed";
        screen_.emplace(320, 240);
        setenv("DISPLAY", screen_->display().c_str(), 1);
        unsetenv("WAYLAND_DISPLAY");
    }
    void TearDown() override { unsetenv("LIBGL_ALWAYS_INDIRECT"); }

    /// Returns the API of a new window's context after drawing with it.
    static int context_api(GLFWwindow* shared) {
        hint_gl_window();
        GLFWwindow* window = create_gl_window(64, 48, "", nullptr, shared);
        if (!window) {
            ADD_FAILURE() << glfw_reason();
            return 0;
        }
        const CurrentWindow current(window);
        GlInfo::query().require_vantage_minimum();
        return glfwGetWindowAttrib(window, GLFW_CONTEXT_CREATION_API);
    }

    std::optional<VirtualScreen> screen_;
};

TEST_F(GlWindow, HasAContextOfTheWindowSystem) {
    const GlfwLibrary library;
    EXPECT_EQ(context_api(nullptr), GLFW_NATIVE_CONTEXT_API);
}

/// An indirect GLX has no OpenGL ES.
TEST_F(GlWindow, HasOneOfEglsWhereTheWindowSystemHasNoOpenGlEs) {
    setenv("LIBGL_ALWAYS_INDIRECT", "1", 1);
    const GlfwLibrary library;
    EXPECT_EQ(context_api(nullptr), GLFW_EGL_CONTEXT_API);
    EXPECT_EQ(glfw_reason(), "no reason given") << "of what was mended";
}

TEST_F(GlWindow, SharesWithOneOfTheSameKind) {
    setenv("LIBGL_ALWAYS_INDIRECT", "1", 1);
    const GlfwLibrary library;
    hint_gl_window();
    GLFWwindow* first = create_gl_window(64, 48, "", nullptr, nullptr);
    ASSERT_TRUE(first);
    unsetenv("LIBGL_ALWAYS_INDIRECT");
    EXPECT_EQ(context_api(first), GLFW_EGL_CONTEXT_API);
}

}  // namespace
}  // namespace vantage
