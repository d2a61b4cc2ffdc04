#include "rig_firmware/stereo/thesis/thesis_passes.h"

namespace vantage::thesis {

PictureWordsPass::PictureWordsPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_picture_words.comp", size) {}

void PictureWordsPass::run(const Texture& picture, const Buffer& words) {
    Program& program = pass_.use();
    program.input("picture", picture);
    words.bind_storage(0);
    pass_.dispatch();
}

SnfPass::SnfPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_snf.comp", size, 16) {}

void SnfPass::run(const Buffer& source, const Buffer& filtered) {
    pass_.use();
    source.bind_storage(0);
    filtered.bind_storage(1);
    pass_.dispatch();
}

DiscontinuityPass::DiscontinuityPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_discontinuities.comp", size) {}

void DiscontinuityPass::run(const Buffer& picture, int threshold, const Buffer& discontinuities) {
    Program& program = pass_.use();
    program.set("threshold", threshold);
    picture.bind_storage(0);
    discontinuities.bind_storage(1);
    pass_.dispatch();
}

HypothesesPass::HypothesesPass(const ShaderLibrary& library, cv::Size size, int disparities)
    : pass_(library, "thesis_hypotheses.comp", size), disparities_(disparities) {}

void HypothesesPass::run(const Buffer& left, const Buffer& right, int first_disparity, int slices,
                         const Buffer& costs) {
    Program& program = pass_.use();
    program.set("first_disparity", first_disparity);
    program.set("disparities", disparities_);
    left.bind_storage(0);
    right.bind_storage(1);
    costs.bind_storage(2);
    pass_.dispatch(slices);
}

PassCost HypothesesPass::cost(int slices) const {
    const double elements = pass_.pixels() * slices;
    return pass_cost((8 + bytes_per_element) * elements, 24 * disparities_per_slice * elements);
}

AggregationPass::AggregationPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_aggregation.comp", size, 16) {}

void AggregationPass::run(const Buffer& costs, const Buffer& discontinuities, int slices,
                          const Buffer& aggregated) {
    pass_.use();
    costs.bind_storage(0);
    discontinuities.bind_storage(1);
    aggregated.bind_storage(2);
    pass_.dispatch(slices);
}

PassCost AggregationPass::cost(int slices) const {
    const double elements = pass_.pixels() * slices;
    return pass_cost((2 * bytes_per_element + 4) * elements, 80 * elements);
}

WinnerPass::WinnerPass(const ShaderLibrary& library, cv::Size size)
    : pass_(library, "thesis_winner.comp", size) {}

void WinnerPass::run(const Buffer& costs, int first_disparity, int slices, const Buffer& keys) {
    Program& program = pass_.use();
    program.set("slices", slices);
    program.set("first_disparity", first_disparity);
    costs.bind_storage(0);
    keys.bind_storage(1);
    pass_.dispatch();
}

PassCost WinnerPass::cost(int slices) const {
    const double elements = pass_.pixels() * slices;
    return pass_cost(bytes_per_element * elements + 8 * pass_.pixels(),
                     5 * disparities_per_slice * elements);
}

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
