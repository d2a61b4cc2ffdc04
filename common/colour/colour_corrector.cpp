#include "common/colour/colour_corrector.h"

namespace vantage {

void ColourCorrector::upload(const ColourImage& picture, const ColourCorrection& correction,
                             const Texture& stage) {
    if (!camera_ || camera_->size() != picture.size())
        camera_.emplace(TextureFormat::rgba8, picture.cols, picture.rows);
    camera_->upload(picture);
    pass_.correct(*camera_, correction, Framebuffer({&stage}));
}

}  // namespace vantage
