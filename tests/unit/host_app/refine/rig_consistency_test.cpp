#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/views/tolerances.h"
#include "tests/unit/host_app/surfaces/drawn_by.h"

namespace vantage {
namespace {

constexpr int consistency_width_px = 61, consistency_height_px = 43;
constexpr float exact = 0.01f;

struct Consistency {
    float is_exact = 0, is_through = 0, is_in_picture = 0, is_same = 0;
};

/// A rig and two others that look in the same direction from other places, so that a pixel moves in
/// proportion to its inverse depth.
class RigConsistencyTest : public testing::Test {
  protected:
    struct Other {
        cv::Mat1f depth_m;
        float x = 0, y = 0, z = 0;  ///< f * where this rig is from there, px * m; z in m
    };

    RigConsistencyTest() {
        others_[0] = {cv::Mat1f(consistency_height_px, consistency_width_px), 31.3f, 7.7f, 0.02f};
        others_[1] = {cv::Mat1f(39, 57), -23.9f, -5.1f, -0.03f};
        cv::RNG random(11);
        // Mostly one surface, with patches that are a little off, far off, or unknown.
        const auto fill = [&](cv::Mat1f& map) {
            for (int v = 0; v < map.rows; ++v)
                for (int u = 0; u < map.cols; ++u) {
                    const auto patch = static_cast<std::size_t>((u / 6 + 3 * (v / 5)) % 7);
                    const float z = std::array{6.0f, 2.5f, 4.0f, 4.22f, 4.0f, 4.0f, 4.0f}[patch];
                    map(v, u) = patch == 2 && random.uniform(0, 2) == 0
                                    ? 0.0f
                                    : z * random.uniform(0.99f, 1.01f);
                }
        };
        fill(own_);
        for (Other& other : others_) fill(other.depth_m);
    }
    /// Compares with one other rig; false if rounding decides between which pixels the place lies.
    bool look(const Other& other, int u, int v, Consistency& found) const {
        const float z = own_(v, u), qz = z + other.z;
        const float x = (static_cast<float>(u) * z + other.x) / qz;
        const float y = (static_cast<float>(v) * z + other.y) / qz;
        const auto is_near_integer = [](float a, float by) {
            return std::abs(a - std::round(a)) < by;
        };
        const float rounding_px = 1 / 64.0f;
        if (is_near_integer(x, rounding_px) || is_near_integer(y, rounding_px)) return false;
        const auto width = static_cast<float>(other.depth_m.cols);
        const auto height = static_cast<float>(other.depth_m.rows);
        if (x < -0.5f || y < -0.5f || x > width - 0.5f || y > height - 0.5f) return true;
        found.is_in_picture = 1;
        float least = INFINITY, most = -INFINITY;
        for (int k = 0; k < 4; ++k) {
            const float off = clamped(other.depth_m, static_cast<int>(std::floor(x)) + (k & 1),
                                      static_cast<int>(std::floor(y)) + (k >> 1)) /
                                  qz -
                              1;
            least = std::min(least, off);
            most = std::max(most, off);
        }
        const float away = std::max({least, -most, 0.0f});
        if (away < same_place_share) found.is_same = 1;
        if (away <= exact) found.is_exact = 1;
        if (least > same_place_share) found.is_through = 1;
        return true;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    cv::Mat1f own_ = cv::Mat1f(consistency_height_px, consistency_width_px);
    std::array<Other, 2> others_;
};

TEST_F(RigConsistencyTest, MatchesTheReference) {
    FullscreenPass pass(shaders_, "rig_consistency.frag", {{"OTHERS", "2"}});
    const Texture depth = texture_of(TextureFormat::r32f, own_);
    const std::array maps{texture_of(TextureFormat::r32f, others_[0].depth_m),
                          texture_of(TextureFormat::r32f, others_[1].depth_m)};
    const cv::Size half((consistency_width_px + 1) / 2, (consistency_height_px + 1) / 2);
    const Texture target(TextureFormat::rgba16f, half.width, half.height);
    Program& program = pass.use();
    program.input("depth_map", depth);
    program.set("exact", exact);
    for (std::size_t i = 0; i < 2; ++i) {
        const Other& other = others_[i];
        Eigen::Matrix4f moved = Eigen::Matrix4f::Identity();
        moved.col(3) = Eigen::Vector4f(other.x, other.y, other.z, 1);
        program.input("other_depth", i, maps[i]);
        program.set("other_from_pixel", i, moved);
        program.set("other_size", i,
                    Eigen::Vector2f(static_cast<float>(other.depth_m.cols),
                                    static_cast<float>(other.depth_m.rows)));
    }
    cv::Mat4f drawn;
    drawn_by(pass, target).convertTo(drawn, CV_32F);

    cv::Vec4i seen(0, 0, 0, 0);
    int judged = 0;
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            const int u = std::min(2 * x, consistency_width_px - 1),
                      v = std::min(2 * y, consistency_height_px - 1);
            Consistency found;
            if (own_(v, u) > 0) {
                const bool first = look(others_[0], u, v, found);
                if (!look(others_[1], u, v, found) || !first) continue;
            }
            found.is_through *= 1 - found.is_same;
            const cv::Vec4f expected(found.is_exact, found.is_through, found.is_in_picture,
                                     found.is_same);
            ASSERT_EQ(drawn(y, x), expected) << u << ' ' << v;
            ++judged;
            for (int c = 0; c < 4; ++c) seen[c] += expected[c] > 0 ? 1 : 0;
        }
    EXPECT_GT(judged, half.area() * 3 / 4);
    // Every result occurs, and not everywhere.
    for (int c = 0; c < 4; ++c) {
        EXPECT_GT(seen[c], judged / 50) << c;
        EXPECT_LT(seen[c], judged) << c;
    }
}

}  // namespace
}  // namespace vantage
