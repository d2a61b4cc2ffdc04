#include "common/gl/tile_pass.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/objects/texture.h"
#include "tests/unit/common/gl/shader_folder.h"

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

TEST_F(TilePassTest, DrawsSelectedTilesAndClearsTheOthers) {
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
        pass_.draw(target, tiles, picture);
        const cv::Mat1b seen = drawn.download();
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x)
                EXPECT_EQ(seen(y, x), named(y / 8, x / 8)) << x << ' ' << y;
    }
}

}  // namespace
}  // namespace vantage
