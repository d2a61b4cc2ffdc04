#include "rig_firmware/stereo/volume/sgm_pass.h"

#include <algorithm>
#include <string>

namespace vantage {
namespace {

/// Most rows whose sums lie in memory at once where only rows are walked.
constexpr int most_band_rows = 256;

/// The rows of a band: bands are equally high, for a low one would leave most of the GPU idle.
int band_rows(int height_px) {
    const int bands = (height_px + most_band_rows - 1) / most_band_rows;
    return (height_px + bands - 1) / bands;
}

/// Slabs whose values a lane of a GPU with few registers can hold while it sums, and while it looks
/// for winners as well.
constexpr int most_summed_slabs = 4, most_decided_slabs = 2;

const char* path_shader(bool in_memory) {
    return in_memory ? "sgm_path_narrow.comp" : "sgm_path.comp";
}

std::size_t volume_size(const StereoLayout& layout, int disparities) {
    return layout.block_pixels() *
           static_cast<std::size_t>(slabs_of(disparities) * slab_disparities);
}

ShaderDefines path_defines(int disparities, const SgmSettings& settings) {
    return {{"SLABS", std::to_string(slabs_of(disparities))},
            {"VALID", std::to_string(valid_in_last_slab(disparities))},
            {"P1", std::to_string(settings.p1)},
            {"P2", std::to_string(settings.p2)}};
}

ShaderDefines operator+(ShaderDefines defines, const ShaderDefines& more) {
    defines.insert(defines.end(), more.begin(), more.end());
    return defines;
}

}  // namespace

SgmCostPass::SgmCostPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
                         int scale)
    : layout_(layout),
      disparities_(disparities),
      program_(Program::compute(library, "sgm_cost.comp", {{"SCALE", std::to_string(scale)}})),
      costs_(volume_size(layout, disparities), GL_DYNAMIC_COPY) {}

void SgmCostPass::run(PassProfiler& profiler, const FeaturePass& features) {
    const int slabs = slabs_of(disparities_);
    const std::size_t slab_pixels = layout_.pixels() * static_cast<std::size_t>(slabs);
    profiler.run("cost", {slab_pixels * 21, static_cast<double>(slab_pixels) * 16 * 16}, [&] {
        program_.use();
        program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program_.set("stride", layout_.stride_px());
        program_.set("plane", static_cast<int>(layout_.block_pixels()));
        features.left_features().bind_storage(0);
        features.right_features().bind_storage(1);
        costs_.bind_storage(2);
        program_.dispatch_over((layout_.width_px + 3) / 4, layout_.height_px, slabs);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

SgmPass::SgmPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
                 const SgmSettings& settings, LaneMapping lanes, double max_operations)
    : SgmPass(library, layout, disparities, settings, nullptr, nullptr, lanes, max_operations) {}

SgmPass::SgmPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
                 const SgmSettings& settings, const Buffer& scratch, const Buffer& for_winners,
                 LaneMapping lanes)
    : SgmPass(library, layout, disparities, settings, &scratch, &for_winners, lanes,
              max_dispatch_operations) {}

SgmPass::SgmPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
                 const SgmSettings& settings, const Buffer* scratch, const Buffer* for_winners,
                 LaneMapping lanes, double max_operations)
    : layout_(layout),
      disparities_(disparities),
      settings_(settings),
      max_operations_(max_operations),
      sum_rows_(settings.columns ? layout.height_px : band_rows(layout.height_px)),
      rows_in_memory_(lanes == LaneMapping::disparities &&
                      slabs_of(disparities) > most_decided_slabs),
      columns_in_memory_(lanes == LaneMapping::disparities &&
                         slabs_of(disparities) > most_summed_slabs),
      rows_(Program::compute(
          library, path_shader(rows_in_memory_),
          path_defines(disparities, settings) + ShaderDefines{{"ALONG", "0"},
                                                              {"ADD", settings.columns ? "1" : "0"},
                                                              {"DECIDE", "1"}})),
      columns_(Program::compute(library, path_shader(columns_in_memory_),
                                path_defines(disparities, settings) +
                                    ShaderDefines{{"ALONG", "1"}, {"ADD", "0"}, {"DECIDE", "0"}})),
      scratch_(scratch),
      for_winners_(for_winners) {
    const std::size_t bytes = volume_size({layout.width_px, sum_rows_}, disparities);
    if (!scratch_ || scratch_->bytes() < bytes) own_sums_.emplace(bytes, GL_DYNAMIC_COPY);
    const std::size_t winner_bytes = layout.block_pixels() * 8;
    if (!for_winners_ || for_winners_->bytes() < winner_bytes)
        own_winners_.emplace(winner_bytes, GL_DYNAMIC_COPY);
    constexpr std::size_t bytes_per_slab = 16;
    if (rows_in_memory_)
        paths_.emplace(
            static_cast<std::size_t>(path_lines() * slabs_of(disparities)) * bytes_per_slab,
            GL_DYNAMIC_COPY);
}

int SgmPass::path_lines() const {
    return columns_in_memory_ ? std::max(layout_.width_px, sum_rows_) : sum_rows_;
}

void SgmPass::run(PassProfiler& profiler, const Buffer& costs) {
    const std::size_t volume = volume_size(layout_, disparities_);
    const double operations = static_cast<double>(volume) * 2 * 11;
    const auto run_paths = [&](Program& program, bool is_in_memory, int lines, int first_row,
                               double line_operations) {
        program.use();
        program.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        program.set("plane", static_cast<int>(layout_.block_pixels()));
        program.set("first_row", first_row);
        program.set("sum_rows", sum_rows_);
        costs.bind_storage(0);
        (own_sums_ ? *own_sums_ : *scratch_).bind_storage(1);
        winners().bind_storage(2);
        if (is_in_memory) {
            program.set("path_lines", path_lines());
            paths_->bind_storage(3);
        }
        constexpr int lanes_of_group = 16;
        dispatch_in_parts(lines, lanes_of_group, line_operations * lines, max_operations_,
                          [&](int first, int count) {
                              program.set("first_line", first);
                              program.dispatch_over(count, 1);
                          });
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    };
    if (settings_.columns)
        profiler.run("column paths", {volume * 5, operations}, [&] {
            run_paths(columns_, columns_in_memory_, layout_.width_px, 0,
                      operations / layout_.width_px);
        });
    profiler.run("row paths", {volume * (settings_.columns ? 5 : 4), operations * 1.3}, [&] {
        for (int row = 0; row < layout_.height_px; row += sum_rows_)
            run_paths(rows_, rows_in_memory_, std::min(sum_rows_, layout_.height_px - row), row,
                      operations * 1.3 / layout_.height_px);
    });
}

}  // namespace vantage
