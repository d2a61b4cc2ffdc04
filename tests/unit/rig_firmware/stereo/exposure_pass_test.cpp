#include "rig_firmware/stereo/features/exposure_pass.h"

#include <array>
#include <span>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "common/gl/context/egl_context.h"
#include "common/image/image_file.h"
#include "tests/references/stereo/exposure_reference.h"

namespace vantage {
namespace {

int read_gain(const ExposurePass& pass) {
    std::array<int, 1> gain{};
    pass.gain().read(0, std::as_writable_bytes(std::span(gain)));
    return gain[0];
}

/// Blocks of grey levels from 40 to 200, with sensor noise of two.
ColourImage noisy_blocks(cv::Size size, double exposure, cv::RNG& random) {
    ColourImage picture(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const double level =
                exposure * (40 + (x / 7 * 29 + y / 5 * 53) % 160) + random.gaussian(2);
            const auto code = cv::saturate_cast<unsigned char>(level);
            picture(y, x) = {code, code, code, 255};
        }
    return picture;
}

TEST(ExposurePass, AgreesWithItsCpuFormBitForBitAtOddSizes) {
    const EglContext context;
    const ShaderLibrary library;
    cv::RNG random(11);
    for (const cv::Size size : {cv::Size(131, 77), cv::Size(37, 1), cv::Size(1, 23)}) {
        ExposurePass pass(library);
        ExposureReference reference;
        for (const double exposure : {1.0, 1.0, 1.04, 0.9, 0.5, 0.52, 1.3}) {
            const ColourImage picture = noisy_blocks(size, exposure, random);
            Texture texture(TextureFormat::rgba8, size.width, size.height);
            texture.upload(picture);
            pass.run(texture);
            EXPECT_EQ(read_gain(pass), reference.gain_4096(to_grey(picture)))
                << size << " at exposure " << exposure;
        }
    }
}

TEST(ExposureReference, FindsTheGainOfWhatStandsStillAndTakesNoiseForNone) {
    cv::RNG random(12);
    ExposureReference exposure;
    const cv::Size size(320, 240);
    EXPECT_EQ(exposure.gain_4096(to_grey(noisy_blocks(size, 1, random))), 4096);
    EXPECT_EQ(exposure.gain_4096(to_grey(noisy_blocks(size, 1, random))), 4096);
    ColourImage brighter = noisy_blocks(size, 1.06, random);
    brighter(cv::Rect(40, 20, 90, 200)).setTo(cv::Scalar(20, 30, 200, 255));  // who came meanwhile
    EXPECT_NEAR(exposure.gain_4096(to_grey(brighter)) / 4096.0, 1.06, 0.005);
}

}  // namespace
}  // namespace vantage
