#include "common/gl/tile_pass.h"

#include <gtest/gtest.h>

#include "common/gl/egl_context.h"
#include "common/gl/texture.h"
#include "tests/unit/gl/shader_folder.h"

namespace vantage {
namespace {

/// A pass that draws white.
class TilePassTest : public testing::Test {
  protected:
    struct WhiteShader : ShaderFolder {
        WhiteShader() {
            write("tone.frag",
                  "layout(location = 0) out float drawn;\nvoid main() { drawn = 1.0; }");
        }
    };

    EglContext context_;
    WhiteShader folder_;
    ShaderLibrary library_{folder_.path()};
    TilePass pass_{library_, "tone.frag"};
};

TEST_F(TilePassTest, DrawsTheTilesThatAreNamedAndClearsTheOthers) {
    // The last column of tiles reaches beyond the picture; the target is half its size.
    const cv::Size picture(40, 32), half(20, 16);
    ASSERT_EQ(TilePass::tiles_of(picture), cv::Size(3, 2));
    Texture tiles(TextureFormat::r8, 3, 2);
    cv::Mat1b named = cv::Mat1b::zeros(2, 3);
    named(0, 1) = named(1, 2) = 255;
    tiles.upload(named);
    const Texture drawn(TextureFormat::r8, half.width, half.height);
    const Framebuffer target({&drawn});
    for (int again = 0; again < 2; ++again) {
        pass_.use();
        pass_.draw(target, tiles, 0, picture);
        const cv::Mat1b seen = drawn.download();
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x)
                EXPECT_EQ(seen(y, x), named(y / 8, x / 8)) << x << ' ' << y;
    }
}

TEST_F(TilePassTest, LeavesRowsAloneThatItIsNotAskedFor) {
    const cv::Size size(TilePass::side_px, TilePass::side_px);
    Texture tiles(TextureFormat::r8, 1, 1), drawn(TextureFormat::r8, size.width, size.height);
    tiles.upload(cv::Mat1b(1, 1, uchar{255}));
    const cv::Mat1b before(size, uchar{77});
    drawn.upload(before);
    const Framebuffer target({&drawn});
    pass_.use();
    pass_.draw(target, tiles, 0, size, cv::Range(3, 7));
    const cv::Mat1b seen = drawn.download();
    for (int y = 0; y < size.height; ++y)
        EXPECT_EQ(cv::norm(seen.row(y),
                           cv::Mat1b(1, size.width, y >= 3 && y < 7 ? uchar{255} : uchar{77}),
                           cv::NORM_INF),
                  0)
            << y;
    EXPECT_FALSE(glIsEnabled(GL_SCISSOR_TEST));
}

}  // namespace
}  // namespace vantage
