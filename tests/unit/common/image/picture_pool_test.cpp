#include "common/image/picture_pool.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace vantage {
namespace {

const cv::Size size(64, 36);

TEST(PicturePool, GivesThePictureThatNobodyHoldsAgain) {
    PicturePool pool;
    const unsigned char* first = nullptr;
    {
        const ColourImage picture = pool.take<ColourImage>(size);
        EXPECT_EQ(picture.size(), size);
        EXPECT_TRUE(picture.isContinuous());
        first = picture.data;
    }
    const ColourImage of_the_system(size);
    EXPECT_NE(of_the_system.data, first) << "which the pool keeps";
    EXPECT_EQ(pool.take<ColourImage>(size).data, first);
}

TEST(PicturePool, GivesNoneThatSomebodyHolds) {
    PicturePool pool;
    const ColourImage held = pool.take<ColourImage>(size);
    const ColourImage part = pool.take<ColourImage>(size).rowRange(3, 5);
    EXPECT_NE(pool.take<ColourImage>(size).data, held.data);
    EXPECT_NE(pool.take<ColourImage>(size).data, part.datastart);
}

TEST(PicturePool, GivesAnySizeAndAnyNumber) {
    PicturePool pool;
    std::vector<ColourImage> held;
    for (int i = 0; i < 40; ++i) held.push_back(pool.take<ColourImage>({8 + i % 2, 5}));
    for (std::size_t i = 0; i < held.size(); ++i) {
        EXPECT_EQ(held[i].cols, 8 + static_cast<int>(i) % 2);
        for (std::size_t k = 0; k < i; ++k) EXPECT_NE(held[i].data, held[k].data);
    }
}

TEST(PicturePool, GivesAnyKind) {
    PicturePool pool;
    for (int i = 0; i < 2; ++i) {
        const auto colour = pool.take<ColourImage>(size);
        EXPECT_EQ(colour.step, 4u * 64);
        const auto disparity = pool.take<DisparityImage>(size);
        EXPECT_EQ(disparity.size(), size);
        EXPECT_EQ(disparity.step, 2u * 64);
        EXPECT_NE(static_cast<const void*>(disparity.data), colour.data);
    }
}

TEST(PicturePool, TakesPicturesBackFromOtherThreadsAndLeavesThemThemselves) {
    ColourImage left;
    {
        PicturePool pool;
        left = pool.take<ColourImage>(size);
        left = cv::Vec4b(1, 2, 3, 4);
        for (int i = 0; i < 200; ++i) {
            ColourImage picture = pool.take<ColourImage>(size);
            picture = cv::Vec4b::all(static_cast<unsigned char>(i));
            std::thread([held = std::move(picture), i] {
                EXPECT_EQ(held(35, 63), cv::Vec4b::all(static_cast<unsigned char>(i)));
            }).join();
        }
    }
    EXPECT_EQ(left(35, 63), cv::Vec4b(1, 2, 3, 4));
}

}  // namespace
}  // namespace vantage
