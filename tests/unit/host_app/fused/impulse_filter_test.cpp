#include "host_app/fused/impulse_filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/image/image.h"
#include "host_app/views/tolerances.h"
#include "tests/support/filled_texture.h"

namespace vantage {
namespace {

template <typename Image>
std::vector<typename Image::value_type> around(const Image& image, int x, int y) {
    std::vector<typename Image::value_type> found;
    for (int k = 0; k < 9; ++k)
        found.push_back(image(std::clamp(y + k / 3 - 1, 0, image.rows - 1),
                              std::clamp(x + k % 3 - 1, 0, image.cols - 1)));
    return found;
}

bool is_at_edge(const DepthImage& depth_m, int x, int y) {
    float near = 1e9f, far = 0;
    for (const float z : around(depth_m, x, y)) {
        near = std::min(near, std::abs(z));
        far = std::max(far, std::abs(z));
    }
    return far > near * depth_edge_ratio;
}

ColourImage reference(const ColourImage& picture, const DepthImage& depth_m) {
    ColourImage filtered = picture.clone();
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            if (!is_at_edge(depth_m, x, y)) continue;
            bool is_impulse = false;
            cv::Vec4b median = picture(y, x);
            for (int c = 0; c < 3; ++c) {
                const int own = picture(y, x)[c];
                std::vector<int> all;
                for (const cv::Vec4b& colour : around(picture, x, y)) all.push_back(colour[c]);
                std::vector<int> others = all;
                others.erase(others.begin() + 4);
                std::sort(others.begin(), others.end());
                is_impulse |= own > others[6] + ImpulseFilter::tolerance ||
                              own < others[1] - ImpulseFilter::tolerance;
                std::nth_element(all.begin(), all.begin() + 4, all.end());
                median[c] = static_cast<uchar>(all[4]);
            }
            if (is_impulse) filtered(y, x) = median;
        }
    return filtered;
}

class ImpulseFilterTest : public testing::Test {
  protected:
    ColourImage filtered(const ColourImage& picture, const DepthImage& depth_m) {
        const Texture colour = filled_texture(TextureFormat::rgba8, picture);
        const Texture depth = filled_texture(TextureFormat::r32f, depth_m);
        return filter_.filter(colour, depth).download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
    ImpulseFilter filter_{shaders_};
};

TEST_F(ImpulseFilterTest, IsItsReferenceAtOddSizes) {
    cv::RNG random(5);
    for (const cv::Size size : {cv::Size(37, 23), cv::Size(1, 1), cv::Size(2, 9)}) {
        ColourImage picture(size);
        for (cv::Vec4b& colour : picture)
            for (int c = 0; c < 4; ++c)
                // Often close to the tolerance, and seldom far beyond it.
                colour[c] = static_cast<uchar>(100 + random.uniform(0, 24) +
                                               (random.uniform(0, 6) == 0 ? 120 : 0));
        // Two surfaces, holes, and depth that is known less well.
        DepthImage depth_m(size);
        for (float& z : depth_m)
            z = random.uniform(0, 9) == 0 ? 2.5f : random.uniform(0, 20) == 0 ? -2.0f : 2.0f;
        if (size.area() > 100) depth_m(cv::Rect(4, 4, 6, 6)) = 0.0f;
        const ColourImage result = filtered(picture, depth_m), wanted = reference(picture, depth_m);
        EXPECT_EQ(cv::norm(result, wanted, cv::NORM_INF), 0) << size;
        if (size.area() > 100) {
            EXPECT_GT(cv::norm(result, picture, cv::NORM_L1), 0);
        }
    }
}

TEST_F(ImpulseFilterTest, TakesSpecksOutAtDepthEdgesAndLeavesLines) {
    ColourImage clean(32, 40, cv::Vec4b(90, 120, 60, 255));
    clean.colRange(20, 40) = cv::Vec4b(20, 30, 200, 255);  // an edge
    clean.col(8) = cv::Vec4b(220, 220, 220, 255);          // a line of one pixel's width
    ColourImage specked = clean.clone();
    specked(10, 3) = cv::Vec4b(0, 0, 0, 96);
    specked(20, 30) = cv::Vec4b(255, 255, 255, 255);
    specked(28, 30) = clean(28, 30) = cv::Vec4b(255, 255, 255, 255);  // within a surface
    DepthImage depth_m(clean.size(), 3.0f);
    depth_m.rowRange(0, 26).forEach<float>(
        [](float& z, const int* at) { z = (at[0] + at[1]) % 2 == 0 ? 3.0f : 3.5f; });
    const ColourImage result = filtered(specked, depth_m);
    clean(10, 3)[3] = 96;
    EXPECT_EQ(cv::norm(result, clean, cv::NORM_INF), 0) << "alpha is kept";
}

}  // namespace
}  // namespace vantage
