// What the chroma of a JPEG is worth: pictures of the virtual stage as a sensor with a Bayer mosaic
// delivers them, and as one that sees every colour at every pixel, packed with each chroma at
// several qualities, against what was packed and against the picture without noise and mosaic.
#include <chrono>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/wire/codec/colour_codec.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/bench/support/cpu_time.h"
#include "tests/bench/support/run_bench.h"
#include "tests/bench/support/size_option.h"
#include "tests/bench/synthesis/matching_rig.h"

namespace vantage {
namespace {

struct Wanted {
    std::string size = "1456x1088";
    double noise_sigma = 1;
    int instants = 3;
    std::vector<int> qualities = {65, 70, 75, 80, 82, 85, 90};
};

struct Picture {
    ColourImage truth, seen;
};

/// What a sensor with red, green, green, blue in every square makes of it.
ColourImage through_mosaic(const ColourImage& colour) {
    cv::Mat1b raw(colour.size());
    for (int y = 0; y < colour.rows; ++y)
        for (int x = 0; x < colour.cols; ++x) raw(y, x) = colour(y, x)[y % 2 + x % 2];
    cv::Mat3b rgb;
    cv::demosaicing(raw, rgb, cv::COLOR_BayerRGGB2RGB_EA);
    ColourImage seen;
    cv::cvtColor(rgb, seen, cv::COLOR_RGB2RGBA);
    return seen;
}

/// Six parts of luma's ratio and one of each chroma's, as video coders are compared, of both
/// pictures as the programme is handed out: chroma of four pixels together.
double handed_out_psnr_db(const ColourImage& a, const ColourImage& b) {
    cv::Mat1b planes_a, planes_b;
    cv::cvtColor(a, planes_a, cv::COLOR_RGBA2YUV_I420);
    cv::cvtColor(b, planes_b, cv::COLOR_RGBA2YUV_I420);
    const int luma = a.rows, chroma = luma / 4;
    const auto of_rows = [&](int first, int rows) {
        return cv::PSNR(planes_a.rowRange(first, first + rows),
                        planes_b.rowRange(first, first + rows));
    };
    return (6 * of_rows(0, luma) + of_rows(luma, chroma) + of_rows(luma + chroma, chroma)) / 8;
}

std::vector<Picture> film(const ShaderLibrary& library, const Wanted& wanted) {
    VirtualStage stage(library, 0);
    std::vector<Picture> pictures;
    std::uint64_t seed = 0;
    for (const double azimuth_deg : {-30.0, -10.0, 10.0, 30.0}) {
        const VirtualRig rig(rig_at(azimuth_deg, size_of(wanted.size)),
                             {.sigma = wanted.noise_sigma, .seed = ++seed}, false);
        for (int i = 0; i < wanted.instants; ++i) {
            VirtualStereoFrame frame =
                rig.render_noiseless(stage, std::chrono::milliseconds(2000 + 700 * i));
            const ColourImage truth = frame.left.clone();
            rig.add_noise(frame, static_cast<std::uint64_t>(i));
            pictures.push_back({truth, frame.left.clone()});
        }
    }
    return pictures;
}

void print_row(const char* sensor, const std::vector<Picture>& pictures, Chroma chroma,
               int quality) {
    JpegEncoder encoder;
    JpegDecoder decoder;
    double bytes = 0, kept_db = 0, true_db = 0, out_db = 0, likeness = 0, packing_ms = 0;
    for (const Picture& picture : pictures) {
        const double before_ms = cpu_ms();
        const std::vector<std::byte> payload = encoder.encode(picture.seen, quality, chroma);
        packing_ms += cpu_ms() - before_ms;
        const ColourImage back = decoder.decode(payload, picture.seen.cols, picture.seen.rows);
        bytes += static_cast<double>(payload.size());
        kept_db += psnr_db(back, picture.seen);
        true_db += psnr_db(back, picture.truth);
        out_db += handed_out_psnr_db(back, picture.truth);
        likeness += ssim(back, picture.truth);
    }
    const auto count = static_cast<double>(pictures.size());
    std::cout << fmt::format(
        "| {} | {} | {} | {:.0f} | {:.2f} | {:.2f} | {:.2f} | {:.4f} | {:.1f} |\n", sensor,
        name_of(chroma), quality, bytes / count / 1e3, kept_db / count, true_db / count,
        out_db / count, likeness / count, packing_ms / count);
}

void measure(const Wanted& wanted) {
    const EglContext context;
    const ShaderLibrary shaders;
    std::vector<Picture> pictures = film(shaders, wanted);
    std::cout << "| sensor | chroma | `jpeg_quality` | kB a frame | as packed, dB | as the stage "
                 "is, dB | the same as handed out, dB | SSIM | packing, ms of a processor |\n"
                 "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const char* sensor : {"every colour", "mosaic"}) {
        for (const Chroma chroma : {Chroma::full, Chroma::half, Chroma::quarter})
            for (const int quality : wanted.qualities) print_row(sensor, pictures, chroma, quality);
        for (Picture& picture : pictures) picture.seen = through_mosaic(picture.seen);
    }
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    using namespace vantage;
    CLI::App app("What the chroma of a JPEG is worth");
    Wanted wanted;
    app.add_option("--size", wanted.size, "Of the pictures")->capture_default_str();
    app.add_option("--noise", wanted.noise_sigma, "Of the sensors, grey levels")
        ->capture_default_str();
    app.add_option("--instants", wanted.instants, "Of the stage, seen by four rigs")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    app.add_option("--qualities", wanted.qualities, "1 to 100 each")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return run_bench("chroma_bench", [&] { measure(wanted); });
}
