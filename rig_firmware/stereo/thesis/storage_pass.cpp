#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

StoragePass::StoragePass(const ShaderLibrary& library, std::string file, cv::Size size,
                         int rows_each)
    : program_(Program::compute(library, std::move(file), {{"ROWS", std::to_string(rows_each)}})),
      size_(size),
      rows_each_(rows_each) {}

Program& StoragePass::use() {
    program_.use();
    program_.set("size", Eigen::Vector2i(size_.width, size_.height));
    return program_;
}

void StoragePass::dispatch(int layers) const {
    program_.dispatch_over(size_.width, (size_.height + rows_each_ - 1) / rows_each_, layers);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace vantage::thesis
