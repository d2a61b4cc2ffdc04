#include <fmt/format.h>
#include <libcamera/libcamera.h>

#include "rig_firmware/capture/camera_access.h"
#include "rig_firmware/probe/probe.h"

namespace vantage {
namespace {

/// Raw and processed formats of a camera with their sizes, as JSON.
nlohmann::json modes_of(libcamera::Camera& camera) {
    nlohmann::json modes = nlohmann::json::array();
    for (const auto role : {libcamera::StreamRole::Raw, libcamera::StreamRole::VideoRecording}) {
        const auto configuration = camera.generateConfiguration({role});
        if (!configuration || configuration->empty()) continue;
        const libcamera::StreamFormats& formats = configuration->at(0).formats();
        for (const libcamera::PixelFormat& format : formats.pixelformats()) {
            nlohmann::json sizes = nlohmann::json::array();
            for (const libcamera::Size& size : formats.sizes(format))
                sizes.push_back({size.width, size.height});
            modes.push_back({{"role", role == libcamera::StreamRole::Raw ? "raw" : "video"},
                             {"format", format.toString()},
                             {"sizes", std::move(sizes)}});
        }
    }
    return modes;
}

std::string mode_line(const nlohmann::json& mode) {
    std::string sizes;
    for (const auto& size : mode["sizes"])
        sizes += fmt::format(" {}x{}", size[0].get<unsigned>(), size[1].get<unsigned>());
    return fmt::format("    {} {}:{}", mode["role"].get<std::string>(),
                       mode["format"].get<std::string>(), sizes);
}

}  // namespace

ProbePart probe_libcamera() {
    ProbePart part{.title = "Cameras of libcamera",
                   .facts = nlohmann::json::array(),
                   .lines = {},
                   .unfit = {}};
    // libcamera logs to standard error by default; this command prints its own report only.
    libcamera::logSetTarget(libcamera::LoggingTargetNone);
    libcamera::CameraManager manager;
    if (const int code = manager.start(); code != 0) {
        part.unfit.push_back(
            fmt::format("libcamera does not start (error {}): its cameras cannot be used", code));
        return part;
    }
    for (const std::shared_ptr<libcamera::Camera>& camera : manager.cameras()) {
        const auto model = camera->properties().get(libcamera::properties::Model);
        nlohmann::json facts = {{"id", camera->id()},
                                {"model", model ? *model : std::string()},
                                {"modes", modes_of(*camera)}};
        part.lines.push_back(
            fmt::format("{} ({})", camera->id(), model ? *model : "of unknown model"));
        for (const auto& mode : facts["modes"]) part.lines.push_back(mode_line(mode));
        part.facts.push_back(std::move(facts));
    }
    manager.stop();
    if (const std::string forbidden = forbidden_camera(); part.facts.empty() && !forbidden.empty())
        part.unfit.push_back("libcamera shows no camera, and " + forbidden);
    return part;
}

}  // namespace vantage
