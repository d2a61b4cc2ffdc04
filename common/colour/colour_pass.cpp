#include "common/colour/colour_pass.h"

namespace vantage {

ColourPass::ColourPass(const ShaderLibrary& library) : pass_(library, "colour_correct.frag") {}

void ColourPass::correct(const Texture& camera, const ColourCorrection& correction,
                         const Framebuffer& target) {
    Program& program = pass_.use();
    program.input("camera", camera);
    program.set("stage_from_camera", Eigen::Matrix3f(correction.matrix.cast<float>()));
    program.set("tone", Eigen::Vector3f(correction.tone.cast<float>()));
    pass_.draw(target);
}

void ColourCorrector::upload(const ColourImage& picture, const ColourCorrection& correction,
                             const Texture& stage) {
    if (!camera_ || camera_->size() != picture.size())
        camera_.emplace(TextureFormat::rgba8, picture.cols, picture.rows);
    camera_->upload(picture);
    pass_.correct(*camera_, correction, Framebuffer({&stage}));
}

}  // namespace vantage
