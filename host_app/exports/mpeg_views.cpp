#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "host_app/camera_paths/camera_path.h"
#include "host_app/exports/moment.h"
#include "host_app/output/media/picture_encoder.h"

namespace vantage {
namespace {

constexpr int colour_bits = 10, depth_bits = 16;
constexpr double most_code = 65535;

struct DepthRange {
    double nearest_m = std::numeric_limits<double>::infinity(), farthest_m = 0;
};

/// The depth range over all rigs, so that their codes are comparable, widened to decimetres.
DepthRange depth_range(const Moment& moment) {
    DepthRange range;
    for (const MomentView& view : moment.views)
        for (const float depth : view.depth_m) {
            if (depth <= 0) continue;
            range.nearest_m = std::min<double>(range.nearest_m, depth);
            range.farthest_m = std::max<double>(range.farthest_m, depth);
        }
    constexpr double per_m = 10;
    range.nearest_m = std::max(1.0, std::floor(range.nearest_m * per_m)) / per_m;
    range.farthest_m = std::ceil(range.farthest_m * per_m + 1) / per_m;
    return range;
}

void append_rows(std::string& bytes, const std::uint8_t* rows, std::ptrdiff_t stride,
                 std::size_t row_bytes, int count) {
    for (int y = 0; y < count; ++y)
        bytes.append(reinterpret_cast<const char*>(rows + y * stride), row_bytes);
}

std::string texture_of(const ColourImage& colour, cv::Size size) {
    PictureConverter converter(size.width, size.height, AV_PIX_FMT_YUV420P10LE);
    const AVFrame& frame = converter.convert(colour);
    std::string bytes;
    for (int plane = 0; plane < 3; ++plane) {
        const int part = plane == 0 ? 1 : 2;
        append_rows(bytes, frame.data[plane], frame.linesize[plane],
                    static_cast<std::size_t>(size.width / part) * sizeof(std::uint16_t),
                    size.height / part);
    }
    return bytes;
}

std::string depth_of(const DepthImage& depth_m, cv::Size size, const DepthRange& range) {
    cv::Mat1w codes(size, std::uint16_t{0});
    const double far = 1 / range.farthest_m, near = 1 / range.nearest_m;
    for (int y = 0; y < size.height && !depth_m.empty(); ++y)
        for (int x = 0; x < size.width; ++x)
            if (const double z = depth_m(y, x); z > 0)
                codes(y, x) = static_cast<std::uint16_t>(std::clamp(
                    std::round(most_code * (1 / z - far) / (near - far)), 1.0, most_code));
    std::string bytes;
    append_rows(bytes, codes.data, static_cast<std::ptrdiff_t>(codes.step),
                static_cast<std::size_t>(size.width) * sizeof(std::uint16_t), size.height);
    // Neutral chroma in 4:2:0.
    const std::u16string no_colour(static_cast<std::size_t>(size.area() / 2), u'\x8000');
    bytes.append(reinterpret_cast<const char*>(no_colour.data()),
                 no_colour.size() * sizeof(char16_t));
    return bytes;
}

}  // namespace

void write_mpeg_views(const Moment& moment, const std::filesystem::path& folder) {
    const DepthRange range = depth_range(moment);
    if (!std::isfinite(range.nearest_m))
        fail("{} is not written: no rig has depth at that moment", folder.string());
    make_folder(folder);
    nlohmann::ordered_json names = nlohmann::ordered_json::array(), cameras = names;
    for (const MomentView& view : moment.views) {
        const cv::Size size(view.colour.cols & ~1, view.colour.rows & ~1);
        const auto file = [&](const char* what, int bits) {
            return folder / fmt::format("{}_{}_{}x{}_yuv420p{}le.yuv", view.rig, what, size.width,
                                        size.height, bits);
        };
        write_text_atomically(file("texture", colour_bits), texture_of(view.colour, size));
        write_text_atomically(file("depth", depth_bits),
                              depth_of(view.depth_of_pixels(), size, range));
        nlohmann::ordered_json camera = omaf_camera(view.rig, view.world_from_camera, view.K, size);
        camera["Depth_range"] = {range.nearest_m, range.farthest_m};
        camera["HasInvalidDepth"] = true;
        camera["BitDepthColor"] = colour_bits;
        camera["BitDepthDepth"] = depth_bits;
        camera["ColorSpace"] = camera["DepthColorSpace"] = "YUV420";
        names.push_back(view.rig);
        cameras.push_back(std::move(camera));
    }
    const nlohmann::ordered_json set{{"Version", "4.0"},
                                     {"Content_name", fmt::format("pulse {}", moment.pulse)},
                                     {"BoundingBox_center", {0, 0, 0}},
                                     {"Fps", moment.pulse_rate_hz},
                                     {"Frames_number", 1},
                                     {"lengthsInMeters", true},
                                     {"sourceCameraNames", names},
                                     {"cameras", cameras}};
    write_text_atomically(folder / "sequence.json", set.dump(1) + '\n');
}

}  // namespace vantage
