#include <array>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/colour/colour_correction.h"
#include "host_app/exports/moment.h"

namespace vantage {
namespace {

std::array<half, 256> linear_light() {
    std::array<half, 256> table;
    constexpr double most = 255;
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = half(static_cast<float>(srgb_decode(static_cast<double>(i) / most)));
    return table;
}

/// OpenEXR uses row vectors and a camera that looks along z with y up.
Imath::M44f world_to_camera(const Pose& world_from_camera) {
    Eigen::Matrix4d camera_from_world = world_from_camera.inverse().matrix();
    camera_from_world.row(1) *= -1;
    Imath::M44f matrix;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            matrix[column][row] = static_cast<float>(camera_from_world(row, column));
    return matrix;
}

Imath::M33f intrinsics(const Eigen::Matrix3d& K) {
    Imath::M33f matrix;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            matrix[row][column] = static_cast<float>(K(row, column));
    return matrix;
}

std::string exr_of(const MomentView& view) {
    static const std::array<half, 256> light = linear_light();
    constexpr std::size_t channels = 3;
    const cv::Size size = view.colour.size();
    std::vector<half> rgb(static_cast<std::size_t>(size.area()) * channels);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int i = 0; i < static_cast<int>(channels); ++i)
                rgb[static_cast<std::size_t>(y * size.width + x) * channels +
                    static_cast<std::size_t>(i)] = light[view.colour(y, x)[i]];
    DepthImage depth_m = view.depth_of_pixels();

    Imf::Header header(size.width, size.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addWorldToCamera(header, world_to_camera(view.world_from_camera));
    header.insert("K", Imf::M33fAttribute(intrinsics(view.K)));
    Imf::FrameBuffer pixels;
    std::size_t i = 0;
    for (const char* channel : {"R", "G", "B"}) {
        header.channels().insert(channel, Imf::Channel(Imf::HALF));
        pixels.insert(channel,
                      Imf::Slice(Imf::HALF, reinterpret_cast<char*>(rgb.data() + i++),
                                 channels * sizeof(half),
                                 channels * sizeof(half) * static_cast<std::size_t>(size.width)));
    }
    if (!depth_m.empty()) {
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
        pixels.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(depth_m.data),
                                      sizeof(float), depth_m.step));
    }
    // Written to memory first, since OpenEXR does not report errors at a file's end.
    Imf::StdOSStream bytes;
    {
        Imf::OutputFile file(bytes, header);
        file.setFrameBuffer(pixels);
        file.writePixels(size.height);
    }
    return bytes.str();
}

}  // namespace

void write_exr_folder(const Moment& moment, const std::filesystem::path& folder) {
    make_folder(folder);
    for (const MomentView& view : moment.views) {
        const std::filesystem::path file = folder / (view.rig + ".exr");
        std::string bytes;
        try {
            bytes = exr_of(view);
        } catch (const std::exception& error) {
            fail("cannot write {}: {}", file.string(), error.what());
        }
        write_text_atomically(file, bytes);
    }
}

}  // namespace vantage
