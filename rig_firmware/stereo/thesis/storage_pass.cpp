#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

StoragePass::StoragePass(const ShaderLibrary& library, std::string file, cv::Size size)
    : program_(Program::compute(library, std::move(file))), size_(size) {}

Program& StoragePass::use() {
    program_.use();
    program_.set("size", Eigen::Vector2i(size_.width, size_.height));
    return program_;
}

void StoragePass::dispatch(int layers, int rows_each) const {
    program_.dispatch_over(size_.width, (size_.height + rows_each - 1) / rows_each, layers);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace vantage::thesis
