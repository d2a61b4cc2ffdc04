#include "tests/bench/film_truth.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "common/image/image_file.h"
#include "common/wire/codec/chroma.h"
#include "common/wire/codec/right_picture.h"
#include "common/wire/frame_codec.h"
#include "host_app/programme/view_painter.h"
#include "host_app/view_sets/image_metrics.h"
#include "host_app/view_sets/immersive_metrics.h"
#include "rig_firmware/stereo/disparity/temporal_pass.h"
#include "tests/bench/fidelity.h"

namespace vantage {
namespace {

constexpr int disparities = 32, wrong_from = 24;
constexpr double rig_distance = 4;  // baselines
constexpr double right_gain = 1.02;

/// A rig that films a scene, with what its daemon does to a pair.
class SceneRig {
  public:
    SceneRig(const ShaderLibrary& library, const FilmTruth& wanted, double baselines)
        : wanted_(wanted),
          baselines_(baselines),
          left_(TextureFormat::rgba8, wanted.size.width, wanted.size.height),
          right_(TextureFormat::rgba8, wanted.size.width, wanted.size.height),
          matcher_(make_matcher(default_matcher(wanted.preset), library,
                                {.width_px = wanted.size.width,
                                 .height_px = wanted.size.height,
                                 .disparities = disparities,
                                 .preset = wanted.preset,
                                 .of_stream = true})),
          denoised_(library, wanted.size.width, wanted.size.height),
          noise_(0x5eed + static_cast<std::uint64_t>(baselines)) {}

    static CameraState camera(cv::Size size, double baselines) {
        const SceneCamera geometry = scene_camera(size);
        CameraState state;
        state.world_from_camera.translation() =
            Eigen::Vector3d(baselines * geometry.baseline_m, 0, 0);
        state.field_of_view_rad = 2 * std::atan(0.5 * size.width / geometry.f_px);
        return state;
    }

    DepthView film(FilmScene scene, double time_s) {
        const cv::Size size = wanted_.size;
        const CameraState state = camera(size, baselines_);
        const SceneCamera geometry = scene_camera(size);
        const ColourImage left = sensed(film_scene(scene, time_s, baselines_, size).colour, 1);
        const ColourImage right =
            sensed(film_scene(scene, time_s, baselines_ + 1, size).colour, right_gain);
        left_.upload(left);
        right_.upload(right);
        const cv::Mat found = denoised_.run(matcher_->match(left_, right_), left_).download();
        DepthView view;
        view.name = fmt::format("{:g}", baselines_);
        view.K = state.K(size.width, size.height);
        view.world_from_camera = state.world_from_camera;
        view.baseline_m = geometry.baseline_m;
        view.colour =
            JpegDecoder().decode(JpegEncoder().encode(left, wanted_.jpeg_quality, Chroma::quarter),
                                 size.width, size.height);
        JpegEncoder jpeg;
        view.right_jpeg = shared(pack_right_picture(jpeg, right));
        view.depth_m = DepthImage(size, 0.0f);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                if (const auto steps = found.at<std::uint16_t>(y, x); steps > 0)
                    view.depth_m(y, x) =
                        static_cast<float>(view.K(0, 0) * geometry.baseline_m *
                                           disparity_steps_per_px / static_cast<double>(steps));
        return view;
    }

  private:
    ColourImage sensed(const ColourImage& seen, double gain) {
        cv::Mat grain(seen.size(), CV_16SC4), levels;
        noise_.fill(grain, cv::RNG::NORMAL, 0, wanted_.noise_sigma);
        seen.convertTo(levels, CV_16S, gain);
        levels += grain;
        ColourImage picture;
        levels.convertTo(picture, CV_8U);
        picture |= cv::Scalar(0, 0, 0, 255);
        return picture;
    }

    FilmTruth wanted_;
    double baselines_;
    Texture left_, right_;
    std::unique_ptr<Matcher> matcher_;
    TemporalPass denoised_;
    cv::RNG noise_;
};

/// What became of one place of the virtual camera.
struct Place {
    Place(std::string its_name, double where, double noise_sigma)
        : name(std::move(its_name)), baselines(where), still(noise_sigma), moving(noise_sigma) {}

    void add(const ColourImage& picture, const SceneFrame& truth) {
        psnr += psnr_db(picture, truth.colour);
        moving_psnr += psnr_db(picture, truth.colour, truth.moving);
        whole_iv += immersive_metrics(picture, truth.colour).iv_psnr_db;
        moving_iv += immersive_metrics(picture, truth.colour, truth.moving).iv_psnr_db;
        cv::Mat difference, channels[4];
        cv::absdiff(picture, truth.colour, difference);
        cv::split(difference, channels);
        const cv::Mat1b wrong =
            cv::max(channels[0], cv::max(channels[1], channels[2])) > wrong_from;
        wrong_pixels += cv::countNonZero(wrong & truth.moving);
        moving_pixels += cv::countNonZero(truth.moving);
        if (pictures++ > 0) {
            const cv::Mat1b moves = truth.moving | before_truth.moving;
            still.add(before, before_truth.colour, picture, truth.colour, ~moves);
            moving.add(before, before_truth.colour, picture, truth.colour, moves);
        }
        before = picture.clone();
        before_truth = truth;
    }

    std::string name;
    double baselines;
    int pictures = 0;
    double psnr = 0, moving_psnr = 0, whole_iv = 0, moving_iv = 0, wrong_pixels = 0,
           moving_pixels = 0;
    Flicker still, moving;
    ColourImage before;
    SceneFrame before_truth;
};

std::string rows(const ShaderLibrary& library, const FilmTruth& wanted, FilmScene scene) {
    std::vector<std::unique_ptr<SceneRig>> rigs;
    for (int i = 0; i < wanted.rigs; ++i)
        rigs.push_back(std::make_unique<SceneRig>(library, wanted, i * rig_distance));
    std::vector<Place> places;
    places.emplace_back("own place", 0, wanted.noise_sigma);
    if (wanted.rigs > 1)
        places.emplace_back("the other's own place", rig_distance, wanted.noise_sigma);
    places.emplace_back("a baseline aside", 1, wanted.noise_sigma);
    const SynthesiserEntry entry = find_synthesiser(default_synthesiser);
    const std::unique_ptr<InstantPreparer> preparer = entry.make_preparer(library);
    ViewPainter painter(entry, {.width_px = wanted.size.width, .height_px = wanted.size.height},
                        library);
    const int settled = cvRound(wanted.settling_s * wanted.rate_hz);
    const int instants = settled + cvRound(wanted.measured_s * wanted.rate_hz);
    for (int k = 0; k < instants; ++k) {
        const double time_s = k / wanted.rate_hz;
        std::vector<DepthView> views;
        for (const auto& rig : rigs) views.push_back(rig->film(scene, time_s));
        if (!wanted.has_background) preparer->background_access()->learn_anew();
        preparer->take(views, 1 / wanted.rate_hz);
        const CameraState first = SceneRig::camera(wanted.size, 0);
        preparer->improve(view_of(first, wanted.size));
        const auto instant = preparer->prepare(view_of(first, wanted.size), prepare_levels()[0]);
        if (k < settled) continue;
        for (Place& place : places) {
            const CameraState camera = SceneRig::camera(wanted.size, place.baselines);
            place.add(painter.paint(*instant, camera, render_levels()[0]),
                      film_scene(scene, time_s, place.baselines, wanted.size));
            if (k + 1 < instants || wanted.pictures.empty()) continue;
            std::filesystem::create_directories(wanted.pictures);
            cv::Mat both;
            cv::hconcat(place.before, place.before_truth.colour, both);
            write_colour_image(std::filesystem::path(wanted.pictures) /
                                   fmt::format("{}_{:g}.png", words_of(scene), place.baselines),
                               ColourImage(both));
        }
    }
    std::string text;
    for (const Place& place : places)
        text += fmt::format(
            "| {} | {} | {:.2f} | {:.2f} | {:.1f} % | {:.2f} | {:.2f} | {:.2f} | {:.2f} "
            "|\n",
            words_of(scene), place.name, place.psnr / place.pictures,
            place.moving_psnr / place.pictures,
            100 * place.wrong_pixels / std::max(place.moving_pixels, 1.0),
            place.still.against_a_camera(), place.moving.against_a_camera(),
            place.whole_iv / place.pictures, place.moving_iv / place.pictures);
    return text;
}

}  // namespace

std::string film_table(const ShaderLibrary& library, const FilmTruth& wanted) {
    std::string text = fmt::format(
        "{} of {}x{}, sensor noise of {:g} grey levels, JPEG quality {}, {:g} instants a second; "
        "the second after the first {:g} s.\n\n"
        "| film | virtual camera | PSNR dB | of what moves | moving pixels wrong by more than {} "
        "levels | flicker: still | moving | IV-PSNR dB | of what moves |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        wanted.rigs == 1 ? "One rig" : fmt::format("{} rigs", wanted.rigs), wanted.size.width,
        wanted.size.height, wanted.noise_sigma, wanted.jpeg_quality, wanted.rate_hz,
        wanted.settling_s, wrong_from);
    for (const FilmScene scene : wanted.scenes) text += rows(library, wanted, scene);
    return text;
}

}  // namespace vantage
