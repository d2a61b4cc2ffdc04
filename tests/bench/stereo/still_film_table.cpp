#include "tests/bench/stereo/still_film_table.h"

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "common/image/image_file.h"
#include "rig_firmware/stereo/disparity/temporal_pass.h"
#include "tests/bench/stereo/filmed_pair.h"
#include "tests/bench/stereo/opencv_matchers.h"

namespace vantage {
namespace {

constexpr int disparities = 48, settling_frames = 25, measured_frames = 15;
constexpr double frames_per_s = 25, noise_sigma = 2, drift = 0.03, drifts_per_s = 0.4;
constexpr double right_exposure = 1.02;
constexpr std::uint64_t stage_frame_sets = 7;
const cv::Size size_px(449, 337);
constexpr std::array presets = {MatchPreset::quality, MatchPreset::balanced, MatchPreset::fast};

struct FilmFrame {
    ColourImage left, right;
    cv::Mat1f disparity_px;
    cv::Mat1b still;   ///< 255: looks as it did in the first frame
    cv::Mat1b moving;  ///< 255: differs from the frame before
};

/// 255 where two pictures without noise differ by more than a grey level.
cv::Mat1b differing(const ColourImage& a, const ColourImage& b) {
    cv::Mat difference;
    cv::absdiff(a, b, difference);
    std::vector<cv::Mat> channels;
    cv::split(difference, channels);
    return cv::max(channels[0], cv::max(channels[1], channels[2])) > 1;
}

std::vector<FilmFrame> film_of(const ShaderLibrary& library, std::uint64_t set) {
    VirtualStage stage(library, set);
    const VirtualRig rig(ideal_virtual_rig({.azimuth_rad = 0.4 * static_cast<double>(set),
                                            .width_px = size_px.width,
                                            .height_px = size_px.height}),
                         {.sigma = noise_sigma});
    std::vector<FilmFrame> film;
    ColourImage before;
    cv::Mat1b changed(size_px, 0);
    for (int i = 0; i < settling_frames + measured_frames; ++i) {
        const double seconds = 1 + i / frames_per_s;
        VirtualStereoFrame seen = rig.render_noiseless(
            stage, std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * seconds)));
        FilmFrame frame;
        frame.moving = cv::Mat1b(size_px, 0);
        if (!before.empty()) frame.moving = differing(seen.left, before);
        before = seen.left.clone();
        changed |= frame.moving;
        cv::dilate(changed, frame.still, cv::Mat(), {-1, -1}, 2);
        frame.still = ~frame.still;
        const double exposure = 1 + drift * std::sin(2 * std::numbers::pi * drifts_per_s * seconds);
        seen.left.convertTo(seen.left, -1, exposure);
        seen.right.convertTo(seen.right, -1, exposure * right_exposure);
        rig.add_noise(seen, static_cast<std::uint64_t>(i));
        frame.left = seen.left;
        frame.right = seen.right;
        seen.exact_disparity.convertTo(frame.disparity_px, CV_32F, 1.0 / disparity_steps_per_px);
        film.push_back(std::move(frame));
    }
    return film;
}

/// What became of the pixels of the measured frames.
class Flicker {
  public:
    void add(const FilmFrame& frame, const cv::Mat1f& found_px) {
        if (!before_.empty()) {
            cv::Mat1f change;
            cv::absdiff(found_px, before_, change);
            jumped_ += cv::countNonZero((change > 1) & frame.still);
            judged_ += cv::countNonZero(frame.still);
        }
        before_ = found_px.clone();
        least_ = least_.empty() ? found_px.clone() : cv::Mat1f(cv::min(least_, found_px));
        most_ = most_.empty() ? found_px.clone() : cv::Mat1f(cv::max(most_, found_px));
        still_ = frame.still;
        const cv::Mat1b bad = cv::abs(found_px - frame.disparity_px) > 2;
        bad_still_ += cv::countNonZero(bad & frame.still);
        all_still_ += cv::countNonZero(frame.still);
        bad_moving_ += cv::countNonZero(bad & frame.moving);
        all_moving_ += cv::countNonZero(frame.moving);
    }
    /// In per cent.
    double jumping() const { return 100 * jumped_ / judged_; }
    double ranging() const {
        return 100.0 * cv::countNonZero((most_ - least_ > 1) & still_) / cv::countNonZero(still_);
    }
    double bad_still() const { return 100 * bad_still_ / all_still_; }
    double bad_moving() const { return 100 * bad_moving_ / std::max(all_moving_, 1.0); }

  private:
    cv::Mat1f before_, least_, most_;
    cv::Mat1b still_;
    double jumped_ = 0, judged_ = 0, bad_still_ = 0, all_still_ = 0, bad_moving_ = 0,
           all_moving_ = 0;
};

struct BeforeAndAfter {
    Flicker raw, denoised;
};

BeforeAndAfter matched_film(const ShaderLibrary& library, MatchPreset preset,
                            const std::vector<FilmFrame>& film) {
    const auto matcher_of = [&](bool of_stream) {
        return make_matcher(default_matcher(preset), library,
                            {.width_px = size_px.width,
                             .height_px = size_px.height,
                             .disparities = disparities,
                             .preset = preset,
                             .of_stream = of_stream});
    };
    const auto matcher = matcher_of(false), stream_matcher = matcher_of(true);
    TemporalPass steady(library, size_px.width, size_px.height);
    BeforeAndAfter result;
    for (std::size_t i = 0; i < film.size(); ++i) {
        const Texture left = uploaded(film[i].left), right = uploaded(film[i].right);
        const cv::Mat1f denoised =
            to_float_px(steady.run(stream_matcher->match(left, right), left).download());
        if (i < settling_frames) continue;
        result.raw.add(film[i], to_float_px(matcher->match(left, right).download()));
        result.denoised.add(film[i], denoised);
    }
    return result;
}

Flicker of_hh4(const std::vector<FilmFrame>& film) {
    OpenCvMatcher hh4(OpenCvMode::hh4, disparities);
    Flicker result;
    for (std::size_t i = settling_frames; i < film.size(); ++i)
        result.add(film[i], hh4.match(to_grey(film[i].left), to_grey(film[i].right), true));
    return result;
}

}  // namespace

void print_still_film_table(const ShaderLibrary& library) {
    fmt::print(
        "Films of the virtual stage at {} frames per second, {}x{} with {} disparities, one second "
        "after their start. The sensor noise is {} grey levels, the exposure drifts by {} %, and "
        "performers move. Frames are matched each by itself, or denoised over time as the daemon "
        "does it. A cell has the per cent of still pixels whose disparity changes by more than a "
        "pixel "
        "from one frame to the next, and within {} frames.\n\n"
        "| scene | HH4 | quality | denoised | balanced | denoised | fast | denoised |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        frames_per_s, size_px.width, size_px.height, disparities, noise_sigma, 100 * drift,
        measured_frames);
    std::string errors;
    std::array<double, 14> sums{};
    for (std::uint64_t set = 0; set < stage_frame_sets; ++set) {
        const std::vector<FilmFrame> film = film_of(library, set);
        const std::string name = fmt::format("stage scene {}", set);
        std::string row;
        std::size_t column = 0;
        const auto add = [&](const Flicker& found) {
            row += fmt::format(" {:.1f} / {:.1f} |", found.jumping(), found.ranging());
            sums[column++] += found.jumping();
            sums[column++] += found.ranging();
        };
        add(of_hh4(film));
        errors += fmt::format("| {} |", name);
        for (const MatchPreset preset : presets) {
            const BeforeAndAfter found = matched_film(library, preset, film);
            add(found.raw);
            add(found.denoised);
            errors += fmt::format(" {:.1f} / {:.1f} | {:.1f} / {:.1f} |", found.raw.bad_still(),
                                  found.raw.bad_moving(), found.denoised.bad_still(),
                                  found.denoised.bad_moving());
        }
        errors += "\n";
        fmt::print("| {} |{}\n", name, row);
        std::cout.flush();
    }
    fmt::print("| **mean** |");
    for (std::size_t i = 0; i < sums.size(); i += 2)
        fmt::print(" **{:.1f} / {:.1f}** |", sums[i] / stage_frame_sets,
                   sums[i + 1] / stage_frame_sets);
    fmt::print(
        "\n\nbad-2.0 in per cent on these films, of still pixels and of moving pixels.\n\n"
        "| scene | quality | denoised | balanced | denoised | fast | denoised |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n{}\n",
        errors);
}

}  // namespace vantage
