#include "rig_firmware/stereo/thesis/disparity_pass.h"

namespace vantage::thesis {

DisparityPass::DisparityPass(const ShaderLibrary& library, cv::Size size, bool fill)
    : pass_(library, "thesis_disparity.frag", {{"FILL", fill ? "1" : "0"}}),
      disparity_(TextureFormat::r16ui, size.width, size.height),
      target_({&disparity_}) {}

const Texture& DisparityPass::run(const Buffer& keys) {
    Program& program = pass_.use();
    program.set("size", Eigen::Vector2i(disparity_.width_px(), disparity_.height_px()));
    keys.bind_storage(0);
    pass_.overwrite(target_);
    return disparity_;
}

PassCost DisparityPass::cost() const {
    const double pixels = static_cast<double>(disparity_.size().area());
    return pass_cost(6 * pixels, 8 * pixels);
}

}  // namespace vantage::thesis
