#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/views/tolerances.h"
#include "tests/unit/host_app/surfaces/drawn_by.h"

namespace vantage {
namespace {

constexpr int memory_width_px = 53, memory_height_px = 37;
// The kinds of background_kinds.glsl.
constexpr uchar lit_background = 64, undecided = 112, new_background = 152, before_background = 255;

/// Learning of depth and colour, one draw from random states to the next.
class BackgroundLearningTest : public testing::Test {
  protected:
    BackgroundLearningTest() {
        for (int v = 0; v < memory_height_px; ++v)
            for (int u = 0; u < memory_width_px; ++u) {
                const uchar kinds[] = {0,   lit_background,   undecided, new_background,
                                       192, before_background};
                seen_(v, u) = {kinds[random_.uniform(0, 6)],
                               static_cast<uchar>(random_.uniform(0, 9)), 0, 255};
                matte_(v, u) =
                    random_.uniform(0, 3) > 0 ? 0 : static_cast<uchar>(random_.uniform(100, 256));
            }
    }
    /// A depth that is about `near` half of the time.
    float metres(float near) {
        return random_.uniform(0, 2) == 0 && near > 0 ? near * random_.uniform(0.998f, 1.002f)
                                                      : random_.uniform(2.0f, 6.0f);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    cv::RNG random_{5};
    cv::Mat4b seen_ = cv::Mat4b(memory_height_px, memory_width_px);
    cv::Mat1b matte_ = cv::Mat1b(memory_height_px, memory_width_px);
};

/// The reference of background_learn.frag and depth_weights.glsl.
struct DepthMemory {
    float spread = 0.0005f, most_instants = 20, most_misses = 6, absorbed_after = 8;

    bool is_one_surface(float now, float before) const {
        return std::abs(now / before - 1) < steady_surface_share + surface_sigmas * spread * now;
    }
    cv::Vec4f next(cv::Vec4f state, float z, uchar kind, uchar matte) const {
        if (matte > 0) {
            if (z == 0) return state;
            const bool goes_on = state[2] > 0 && is_one_surface(z, state[2]);
            const float instants = goes_on ? state[3] + 1 : 1;
            state[2] = goes_on ? state[2] + (z - state[2]) / instants : z;
            state[3] = instants;
            return instants >= absorbed_after ? cv::Vec4f(state[2], 1, 0, 0) : state;
        }
        state[2] = state[3] = 0;
        if (z == 0) return state;
        if (state[0] <= 0 || kind == new_background || kind == undecided) return {z, 1, 0, 0};
        if (kind == before_background) return state;
        const float instants = std::floor(state[1]);
        if (is_one_surface(z, state[0])) {
            const float share = 1 / (instants + 1);
            return {1 / ((1 - share) / state[0] + share / z), std::min(instants + 1, most_instants),
                    0, 0};
        }
        const float patience = std::clamp(instants, 2.0f, most_misses);
        const float count = state[1] + 1 / 32.0f;
        if (count - instants < patience / 32) return {state[0], count, 0, 0};
        return {z, std::min(instants + patience, most_instants), 0, 0};
    }
};

TEST_F(BackgroundLearningTest, LearnsDepthLikeTheReference) {
    cv::Mat1f depth(memory_height_px, memory_width_px);
    cv::Mat4f before(memory_height_px, memory_width_px);
    for (int v = 0; v < memory_height_px; ++v)
        for (int u = 0; u < memory_width_px; ++u) {
            const float z = random_.uniform(0, 6) == 0 ? 0 : random_.uniform(2.0f, 6.0f);
            depth(v, u) = z;
            const int instants = random_.uniform(1, 21), misses = random_.uniform(0, 6);
            before(v, u) = {random_.uniform(0, 8) == 0 ? 0 : metres(z),
                            static_cast<float>(instants) + static_cast<float>(misses) / 32,
                            random_.uniform(0, 4) == 0 ? 0 : metres(z),
                            static_cast<float>(random_.uniform(1, 10))};
        }
    const DepthMemory memory;
    FullscreenPass pass(shaders_, "background_learn.frag");
    const Texture depth_map = texture_of(TextureFormat::r32f, depth);
    const Texture background_before = texture_of(TextureFormat::rgba32f, before);
    const Texture seen = texture_of(TextureFormat::rgba8, seen_);
    const Texture matte = texture_of(TextureFormat::r8, matte_);
    const Texture target(TextureFormat::rgba32f, memory_width_px, memory_height_px);
    Program& program = pass.use();
    program.input("depth_map", depth_map);
    program.input("background_before", background_before);
    program.input("seen", seen);
    program.input("matte", matte);
    program.set("spread", memory.spread);
    program.set("has_before", 1.0f);
    program.set("most_instants", memory.most_instants);
    program.set("most_misses", memory.most_misses);
    program.set("absorbed_after", memory.absorbed_after);
    const cv::Mat4f learnt = drawn_by(pass, target);
    int moved = 0;
    for (int v = 0; v < memory_height_px; ++v)
        for (int u = 0; u < memory_width_px; ++u) {
            const cv::Vec4f expected =
                memory.next(before(v, u), depth(v, u), seen_(v, u)[0], matte_(v, u));
            moved += expected[0] != before(v, u)[0] ? 1 : 0;
            for (int c = 0; c < 4; ++c)
                ASSERT_NEAR(learnt(v, u)[c], expected[c], 1e-5 * std::max(1.0f, expected[c]))
                    << u << ' ' << v << " channel " << c;
        }
    EXPECT_GT(moved, memory_width_px * memory_height_px / 10);
    EXPECT_LT(moved, memory_width_px * memory_height_px * 9 / 10);

    pass.use().set("has_before", 0.0f);
    const cv::Mat4f first = drawn_by(pass, target);
    for (int v = 0; v < memory_height_px; ++v)
        for (int u = 0; u < memory_width_px; ++u)
            ASSERT_EQ(first(v, u), cv::Vec4f(depth(v, u), 1, 0, 0)) << u << ' ' << v;
}

TEST_F(BackgroundLearningTest, LearnsColourLikeTheReference) {
    constexpr float most_instants = 12;
    cv::Mat4b picture(memory_height_px, memory_width_px);
    cv::Mat4f past(memory_height_px, memory_width_px);
    for (int v = 0; v < memory_height_px; ++v)
        for (int u = 0; u < memory_width_px; ++u) {
            const int off = random_.uniform(0, 3) == 0 ? 40 : 3;
            for (int c = 0; c < 3; ++c) {
                picture(v, u)[c] = static_cast<uchar>(random_.uniform(50, 200));
                past(v, u)[c] =
                    static_cast<float>(picture(v, u)[c] + random_.uniform(-off, off + 1)) / 255;
            }
            picture(v, u)[3] = 255;
            past(v, u)[3] = static_cast<float>(random_.uniform(-4, 13));
        }
    // Foreground comes in whole patches, so that much of the background is visible.
    for (int v = 0; v < memory_height_px; ++v)
        for (int u = 0; u < memory_width_px; ++u) matte_(v, u) = (u / 9 + v / 8) % 3 == 0 ? 200 : 0;
    cv::Mat past_halves;
    past.convertTo(past_halves, CV_16F);
    past_halves.convertTo(past, CV_32F);

    FullscreenPass pass(shaders_, "background_colour.frag");
    const Texture now = texture_of(TextureFormat::rgba8, picture);
    const Texture before = texture_of(TextureFormat::rgba16f, past_halves);
    const Texture seen = texture_of(TextureFormat::rgba8, seen_);
    const Texture matte = texture_of(TextureFormat::r8, matte_, Filter::linear);
    const Texture shown(TextureFormat::rgba8, memory_width_px, memory_height_px);
    const Texture mean(TextureFormat::rgba16f, memory_width_px, memory_height_px);
    Program& program = pass.use();
    program.input("picture", now);
    program.input("before", before);
    program.input("seen", seen);
    program.input("matte", matte);
    program.set("has_before", 1.0f);
    program.set("most_instants", most_instants);
    pass.draw(Framebuffer{&shown, &mean});
    const cv::Mat4b shown_now = shown.download();
    cv::Mat4f mean_now;
    mean.download().convertTo(mean_now, CV_32F);
    int hidden_pixels = 0;
    for (int v = 0; v < memory_height_px; ++v)
        for (int u = 0; u < memory_width_px; ++u) {
            bool is_hidden = false;
            for (int y : {-2, -1, 1, 2})
                for (int x : {-2, -1, 1, 2})
                    is_hidden = is_hidden || clamped(matte_, u + x, v + y) > 0;
            hidden_pixels += is_hidden ? 1 : 0;
            cv::Vec4f expected = past(v, u);
            if (!is_hidden) {
                double off = 0;
                for (int c = 0; c < 3; ++c)
                    off = std::max(off, std::abs(picture(v, u)[c] / 255.0 - past(v, u)[c]));
                const double change = std::max(seen_(v, u)[1] / 255.0, 0.4 * off);
                const double way = std::clamp((change - 0.01) / 0.01, 0.0, 1.0);
                // A pixel that shows something else may go on changing.
                const uchar kind = seen_(v, u)[0];
                const float counted = past(v, u)[3];
                const double instants = kind != undecided && kind != new_background
                                            ? std::min(counted + 1, most_instants)
                                        : counted > 1 ? counted / 2
                                                      : std::max(counted - 1, -4.0f);
                const double share =
                    std::max(1 / (std::max(instants, 0.0) + 1), way * way * (3 - 2 * way));
                for (int c = 0; c < 3; ++c)
                    expected[c] +=
                        static_cast<float>(share * (picture(v, u)[c] / 255.0 - past(v, u)[c]));
                expected[3] = static_cast<float>(instants);
            }
            // Halves of floats below 1 are exact to 1/4096, half of their last bit.
            for (int c = 0; c < 4; ++c)
                ASSERT_NEAR(mean_now(v, u)[c], expected[c], 1.0 / 2048) << u << ' ' << v;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(shown_now(v, u)[c], 255 * expected[c], 0.6) << u << ' ' << v;
            ASSERT_EQ(shown_now(v, u)[3], is_hidden ? 64 : 255) << u << ' ' << v;
        }
    EXPECT_GT(hidden_pixels, memory_width_px * memory_height_px / 5);
    EXPECT_LT(hidden_pixels, memory_width_px * memory_height_px * 4 / 5);
}

}  // namespace
}  // namespace vantage
