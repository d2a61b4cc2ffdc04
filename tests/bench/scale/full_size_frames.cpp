#include "tests/bench/scale/full_size_frames.h"

#include <chrono>

#include "common/virtual_stage/virtual_rig.h"
#include "tests/bench/support/size_option.h"
#include "tests/bench/synthesis/matching_rig.h"

namespace vantage {

std::vector<PackedFrame> film_full_size(const ShaderLibrary& library, const FullSizeFrames& wanted,
                                        double azimuth_deg, std::uint64_t seed) {
    VirtualStage stage(library, 0);
    const VirtualRig colours(rig_at(azimuth_deg, size_of(wanted.colour)),
                             {.sigma = wanted.noise_sigma, .seed = seed}, false);
    const StereoCalibration small = rig_at(azimuth_deg, size_of(wanted.depth));
    MatchingRig::Settings settings;
    settings.size = size_of(wanted.depth);
    settings.disparities = wanted.disparities;
    settings.preset = MatchPreset::balanced;
    settings.noise_sigma = wanted.noise_sigma;
    MatchingRig depths(library, azimuth_deg, seed, settings);
    FrameEncoder encoder(wanted.jpeg_quality, parse_chroma(wanted.chroma));
    std::vector<PackedFrame> frames;
    for (int i = 0; i < wanted.instants; ++i) {
        const std::chrono::milliseconds at(2000 + 700 * i);
        const auto number = static_cast<std::uint64_t>(i);
        depths.film(stage, at, number);
        const DepthView seen = depths.view(true);
        RigFrame frame;
        frame.rig = seen.name;
        frame.synchronized = true;
        frame.trigger_index = number + 1;
        frame.colour = colours.render(stage, at, number).left;
        frame.disparity = disparity_from_depth(seen.depth_m, small.rectified);
        frame.max_disparity_px = static_cast<float>(wanted.disparities);
        frame.geometry = rig_at(azimuth_deg, size_of(wanted.colour)).rectified;
        frame.world_from_camera = seen.world_from_camera;
        frames.push_back(encoder.encode(frame));
    }
    return frames;
}

}  // namespace vantage
