#include <algorithm>

#include "rig_firmware/capture/pixel_format.h"
#include "rig_firmware/capture/v4l2/v4l2_device.h"
#include "rig_firmware/probe/probe.h"

namespace vantage {
namespace {

bool is_understood(const V4l2Format& format) {
    const auto& known = known_pixel_formats();
    return std::any_of(known.begin(), known.end(), [&](PixelFormat candidate) {
        return fourcc_of(candidate) == format.fourcc;
    });
}

nlohmann::json facts_of(const V4l2Format& format) {
    nlohmann::json sizes = nlohmann::json::array();
    for (const V4l2Size& size : format.sizes)
        sizes.push_back({{"width_px", size.width_px},
                         {"height_px", size.height_px},
                         {"rates_hz", size.rates_hz}});
    return {{"fourcc", fourcc_text(format.fourcc)},
            {"is_understood", is_understood(format)},
            {"description", format.description},
            {"any_size_between", format.any_size_between},
            {"sizes", std::move(sizes)}};
}

std::string line_of(const V4l2Format& format) {
    std::string sizes;
    for (const V4l2Size& size : format.sizes) {
        sizes += fmt::format(" {}x{}", size.width_px, size.height_px);
        if (!size.rates_hz.empty())
            sizes += fmt::format("@{:.4g}Hz",
                                 *std::max_element(size.rates_hz.begin(), size.rates_hz.end()));
    }
    return fmt::format("    '{}' {}{}:{}", fourcc_text(format.fourcc), format.description,
                       format.any_size_between ? ", any size between" : "", sizes);
}

void add_camera(ProbePart& part, const V4l2Device& device) {
    const std::string node = device.path().string();
    const std::string stable = stable_video_path(device.path()).string();
    const std::vector<V4l2Format> formats = device.formats();
    nlohmann::json format_facts = nlohmann::json::array(), controls = nlohmann::json::array();
    part.lines.push_back(fmt::format("{} '{}' on {}{}", node, device.card(), device.bus(),
                                     stable.empty() ? "" : ", always as " + stable));
    std::string others;
    for (const V4l2Format& format : formats) {
        format_facts.push_back(facts_of(format));
        if (is_understood(format))
            part.lines.push_back(line_of(format));
        else
            others += fmt::format("{}'{}'", others.empty() ? "" : ", ", fourcc_text(format.fourcc));
    }
    if (!others.empty()) part.lines.push_back("    of no use to Vantage: " + others);
    for (const V4l2Control& control : device.controls()) {
        controls.push_back({{"name", control.name},
                            {"least", control.least},
                            {"most", control.most},
                            {"usual", control.usual},
                            {"value", control.value},
                            {"is_writable", control.is_writable}});
        part.lines.push_back(fmt::format("    \"{}\" = {} ({} to {})", control.name, control.value,
                                         control.least, control.most));
    }
    part.facts.push_back({{"path", node},
                          {"stable_path", stable},
                          {"card", device.card()},
                          {"bus", device.bus()},
                          {"formats", std::move(format_facts)},
                          {"controls", std::move(controls)}});
    for (const AutomaticControl& automatic : automatics_of(device))
        if (!automatic.is_fixed)
            part.unfit.push_back(fmt::format(
                "{} ('{}'): {} is automatic, and the cameras of a stage will differ: set \"{}\" = "
                "{} in [source.controls]",
                node, device.card(), automatic.what, automatic.control, automatic.fixed_value));
    if (std::none_of(formats.begin(), formats.end(), is_understood))
        part.unfit.push_back(fmt::format(
            "{} ('{}') has no picture format that Vantage understands: it can only be used through "
            "libcamera, if it is listed there",
            node, device.card()));
}

}  // namespace

ProbePart probe_v4l2() {
    ProbePart part{
        .title = "Cameras of V4L2", .facts = nlohmann::json::array(), .lines = {}, .unfit = {}};
    for (const std::filesystem::path& node : list_video_nodes()) {
        try {
            const V4l2Device device(node);
            if (device.captures()) add_camera(part, device);
        } catch (const Error& error) {
            part.unfit.emplace_back(error.what());
        }
    }
    return part;
}

}  // namespace vantage
