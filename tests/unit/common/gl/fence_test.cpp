#include "common/gl/objects/fence.h"

#include <future>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "common/gl/context/context_loss.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/sliced_drawing.h"
#include "tests/support/gpu_reset.h"
#include "tests/unit/common/gl/shader_folder.h"

namespace vantage {
namespace {

constexpr int drawn_width_px = 333, drawn_height_px = 217;

struct DrawnPicture {
    Texture texture{TextureFormat::r32ui, drawn_width_px, drawn_height_px};
    Fence drawn;
};

/// A picture whose every pixel says its place, drawn with the context that is current; not waited
/// for.
DrawnPicture draw_places() {
    const ShaderFolder folder;
    folder.write("places.frag",
                 "layout(location = 0) out uint place;\n"
                 "void main() { uvec2 at = uvec2(gl_FragCoord.xy); place = at.y * 1000u + at.x; }");
    const ShaderLibrary library(folder.path());
    FullscreenPass pass(library, "places.frag");
    DrawnPicture picture;
    const Framebuffer target({&picture.texture});
    pass.use();
    pass.draw(target);
    picture.drawn = Fence::insert();
    return picture;
}

void expect_places(const Texture& texture) {
    const cv::Mat picture = texture.download();
    for (const cv::Point at : {cv::Point(0, 0), cv::Point(332, 0), cv::Point(7, 216)})
        EXPECT_EQ(picture.at<int>(at), at.y * 1000 + at.x) << at;
}

/// What another thread draws with a context that shares with this one.
DrawnPicture drawn_elsewhere(const EglContext& context) {
    const EglContext sharing = EglContext::sharing_with(context);
    std::promise<DrawnPicture> promise;
    std::thread([&] {
        try {
            const CurrentContext current(sharing);
            promise.set_value(draw_places());
        } catch (...) {
            promise.set_exception(std::current_exception());
        }
    }).join();
    return promise.get_future().get();
}

void draw_in_slices_and_wait() {
    const SlicedDrawing slices(std::chrono::milliseconds(4), nullptr);
    (void)draw_places();
}

TEST(Fence, AllowsReadingWhatAnotherThreadDrew) {
    const EglContext context;
    const DrawnPicture picture = drawn_elsewhere(context);
    EXPECT_TRUE(picture.drawn.reached_within(std::chrono::seconds(60)));
    EXPECT_TRUE(picture.drawn.reached()) << "and stays so";
    expect_places(picture.texture);
}

TEST(Fence, HoldsAContextUntilAnotherOneHasDrawn) {
    const EglContext context;
    const DrawnPicture picture = drawn_elsewhere(context);
    picture.drawn.hold_current_context();
    expect_places(picture.texture);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST(Fence, IsReachedWithoutAPoint) {
    const Fence none;
    EXPECT_TRUE(none.reached());
    none.hold_current_context();
}

TEST(Fence, CountsAGpuThatDoesNotFinishInTimeAsLost) {
    const ShaderFolder folder;
    folder.write(
        "long.frag",
        "uniform int turns;\n"
        "layout(location = 0) out uint sum;\n"
        "void main() { sum = 0u; for (int i = 0; i < turns; ++i) sum = sum * 3u + uint(i); }");
    const EglContext context;
    const ShaderLibrary library(folder.path());
    FullscreenPass pass(library, "long.frag");
    const Texture texture(TextureFormat::r32ui, 512, 512);
    const Framebuffer target({&texture});
    pass.use().set("turns", 2000);
    pass.draw(target);
    const Fence drawn = Fence::insert();
    try {
        drawn.wait("a test drew", std::chrono::microseconds(1));
        FAIL() << "500 million turns took a microsecond";
    } catch (const ContextLost& lost) {
        EXPECT_NE(std::string(lost.what()).find("a test drew"), std::string::npos) << lost.what();
    }
    drawn.wait("a test drew");
    EXPECT_TRUE(drawn.reached());
}

TEST(Fence, CountsAGpuThatHangsAsLostWithoutAReportOfTheDriver) {
    const EglContext context;
    const Fence drawn = Fence::insert();
    hang_gpu();
    try {
        drawn.wait("a test drew");
        FAIL() << "the fence was reached";
    } catch (const ContextLost& lost) {
        EXPECT_STREQ(lost.what(),
                     "the GPU has not finished its work within 10000 ms while a test drew: it "
                     "hangs, or its driver has reset it");
    }
    EXPECT_THROW(draw_in_slices_and_wait(), ContextLost);
}

TEST(Fence, MovesItsPoint) {
    const EglContext context;
    Fence first = Fence::insert();
    Fence second = std::move(first);
    Fence third;
    third = std::move(second);
    EXPECT_TRUE(third.reached_within(std::chrono::seconds(60)));
}

}  // namespace
}  // namespace vantage
