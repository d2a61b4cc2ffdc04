#include <gtest/gtest.h>

#include "rig_firmware/stereo/thesis/thesis_passes.h"
#include "tests/references/thesis/discontinuity_reference.h"
#include "tests/unit/rig_firmware/stereo/thesis_buffers.h"

namespace vantage::thesis {
namespace {

class DiscontinuityPassTest : public testing::TestWithParam<PictureCase> {};

TEST_P(DiscontinuityPassTest, EqualsItsReference) {
    const EglContext context;
    const ShaderLibrary library;
    const ColourImage picture = blobs(GetParam().width_px, GetParam().height_px, 4);
    DiscontinuityPass pass(library, picture.size());
    const Buffer source = to_buffer(picture), map = empty_words(picture.size());
    for (const int threshold : {0, 24, 254}) {
        pass.run(source, threshold, map);
        EXPECT_EQ(cv::norm(codes_in(map, picture.size()),
                           discontinuity_reference(picture, threshold), cv::NORM_INF),
                  0)
            << "threshold " << threshold;
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, DiscontinuityPassTest, testing::ValuesIn(picture_cases));

TEST(DiscontinuityReference, CutsBothSidesOfAnEdgeAndThePicturesRim) {
    ColourImage picture(3, 4, cv::Vec4b(50, 50, 50, 255));
    picture.colRange(2, 4).setTo(cv::Scalar(50, 50, 80, 255));
    // Above, middle, below: 4, 0 and 8 on top of what the columns have.
    const cv::Mat1b cut = (cv::Mat1b(3, 4) << 5, 6, 5, 6, 1, 2, 1, 2, 9, 10, 9, 10);
    const cv::Mat1b rim_only = (cv::Mat1b(3, 4) << 5, 4, 4, 6, 1, 0, 0, 2, 9, 8, 8, 10);
    EXPECT_EQ(cv::norm(discontinuity_reference(picture, 29), cut, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(discontinuity_reference(picture, 30), rim_only, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace vantage::thesis
