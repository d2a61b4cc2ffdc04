#include "rig_firmware/stereo/features/permeability_pass.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Of four rows, whose permeabilities are words.
std::size_t row_groups(const StereoLayout& layout) {
    return static_cast<std::size_t>((layout.height_px + 3) / 4);
}

}  // namespace

PermeabilityTable permeability_table(double sigma) {
    PermeabilityTable table{};
    for (std::size_t step = 0; step < table.size(); ++step)
        table[step] = static_cast<std::uint32_t>(
            std::clamp(std::lround(16 * std::exp(-static_cast<double>(step) / sigma)), 0L, 15L));
    return table;
}

PermeabilityPass::PermeabilityPass(const ShaderLibrary& library, const StereoLayout& layout,
                                   double sigma, PermeabilityGuide guide)
    : layout_(layout),
      median_program_(Program::compute(library, "stereo_median_luma.comp")),
      permeability_program_(Program::compute(library, "stereo_permeability.comp")),
      along_(layout.pixels(), GL_DYNAMIC_COPY),
      down_(row_groups(layout) * static_cast<std::size_t>(layout.stride_px()) * 4, GL_DYNAMIC_COPY),
      table_(Buffer::of<std::uint32_t>(permeability_table(sigma))) {
    if (guide == PermeabilityGuide::median)
        medians_.emplace(layout.luma_words() * 2 * 4, GL_DYNAMIC_COPY);
}

void PermeabilityPass::run(PassProfiler& profiler, const Buffer& luma) {
    const std::size_t pixels = layout_.pixels();
    if (medians_)
        profiler.run("guide", {pixels * 4, static_cast<double>(pixels) * 80}, [&] {
            median_program_.use();
            median_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
            median_program_.set("row_words", layout_.luma_row_words());
            luma.bind_storage(0);
            medians_->bind_storage(1);
            median_program_.dispatch_over(layout_.luma_row_words(), layout_.height_px, 2);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        });
    profiler.run("permeability", {pixels * 6, static_cast<double>(pixels) * 41}, [&] {
        permeability_program_.use();
        permeability_program_.set("size", Eigen::Vector2i(layout_.width_px, layout_.height_px));
        permeability_program_.set("row_words", layout_.luma_row_words());
        permeability_program_.set("stride", layout_.stride_px());
        (medians_ ? *medians_ : luma).bind_storage(0);
        along_.bind_storage(1);
        down_.bind_storage(2);
        table_.bind_storage(3);
        permeability_program_.dispatch_over(layout_.stride_px() / 4,
                                            static_cast<int>(row_groups(layout_)));
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    });
}

}  // namespace vantage
