#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "host_app/exports/edit_list.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// Edit lists begin at this hour by custom, so that material before the start can be added.
constexpr SmpteCode edit_start{1, 0, 0, 0, false};

std::int64_t first_record_number(const EditList& list) {
    SmpteCode start = edit_start;
    start.is_drop_frame = list.count.is_drop_frame;
    return *list.count.frame_of(start);
}

/// A path as a URL, as RFC 8089 has it.
std::string file_url(const std::filesystem::path& path) {
    std::string url = "file://";
    for (const char c : path.string()) {
        const auto byte = static_cast<unsigned char>(c);
        const bool is_plain =
            std::isalnum(byte) != 0 || std::string_view("/-._~").find(c) != std::string_view::npos;
        url += is_plain && byte < 0x80 ? std::string(1, c) : fmt::format("%{:02X}", byte);
    }
    return url;
}

/// Writes the objects of OpenTimelineIO's schema at the rate of one list.
class OtioWriter {
  public:
    explicit OtioWriter(const EditList& list) : list_(list) {}

    Json timeline() const {
        Json tracks = Json::array();
        for (const EditSource& source : list_.sources) tracks.push_back(source_track(source));
        tracks.push_back(play_list());
        return {{"OTIO_SCHEMA", "Timeline.1"},
                {"metadata", Json::object()},
                {"name", list_.name},
                {"global_start_time", time(first_record_number(list_))},
                {"tracks",
                 {{"OTIO_SCHEMA", "Stack.1"},
                  {"metadata", Json::object()},
                  {"name", "tracks"},
                  {"source_range", nullptr},
                  {"effects", Json::array()},
                  {"markers", Json::array()},
                  {"enabled", true},
                  {"children", tracks}}}};
    }

  private:
    Json time(std::int64_t frames) const {
        return {{"OTIO_SCHEMA", "RationalTime.1"},
                {"rate", list_.rate_hz},
                {"value", static_cast<double>(frames)}};
    }
    Json range(std::int64_t in, std::int64_t frames) const {
        return {
            {"OTIO_SCHEMA", "TimeRange.1"}, {"duration", time(frames)}, {"start_time", time(in)}};
    }
    Json reference(const EditSource& source) const {
        Json json{{"OTIO_SCHEMA", source.file ? "ExternalReference.1" : "MissingReference.1"},
                  {"metadata", Json::object()},
                  {"name", source.range.name},
                  {"available_range", range(source.range.in, source.range.frames)},
                  {"available_image_bounds", nullptr}};
        if (source.file) json["target_url"] = file_url(*source.file);
        return json;
    }
    static Json marker(const std::string& name, const Json& marked_range) {
        return {{"OTIO_SCHEMA", "Marker.2"},
                {"metadata", Json::object()},
                {"name", name},
                {"color", "GREEN"},
                {"marked_range", marked_range}};
    }
    Json clip(const EditSource& source, const std::string& name, const Json& source_range,
              bool is_enabled) const {
        return {{"OTIO_SCHEMA", "Clip.2"},
                {"metadata", {{"cmx_3600", {{"reel", source.reel}}}}},
                {"name", name},
                {"source_range", source_range},
                {"effects", Json::array()},
                {"markers", Json::array()},
                {"enabled", is_enabled},
                {"media_references", {{"DEFAULT_MEDIA", reference(source)}}},
                {"active_media_reference_key", "DEFAULT_MEDIA"}};
    }
    static Json track(const std::string& name, Json children) {
        return {{"OTIO_SCHEMA", "Track.1"},
                {"metadata", Json::object()},
                {"name", name},
                {"source_range", nullptr},
                {"effects", Json::array()},
                {"markers", Json::array()},
                {"enabled", true},
                {"children", std::move(children)},
                {"kind", "Video"}};
    }
    Json source_track(const EditSource& source) const {
        Json whole =
            clip(source, source.range.name, range(source.range.in, source.range.frames), false);
        for (const EditMark& mark : source.marks)
            whole["markers"].push_back(marker(mark.name, range(mark.in, mark.frames)));
        return track(source.reel, Json::array({whole}));
    }
    Json play_list() const {
        Json events = Json::array();
        for (const EditEvent& event : list_.events) {
            Json json =
                clip(list_.sources[event.source], event.name, range(event.in, event.frames), true);
            if (event.clip > 0) json["metadata"]["vantage"] = {{"clip", event.clip}};
            if (event.speed != 1)
                json["effects"].push_back({{"OTIO_SCHEMA", "LinearTimeWarp.1"},
                                           {"metadata", Json::object()},
                                           {"name", ""},
                                           {"effect_name", "LinearTimeWarp"},
                                           {"time_scalar", event.speed}});
            events.push_back(std::move(json));
        }
        return track("Play list", std::move(events));
    }

    const EditList& list_;
};

/// The reels of all sources in the letters and the length of CMX 3600, different from each other.
std::vector<std::string> short_reels(const EditList& list) {
    constexpr std::size_t most_letters = 8;
    std::set<std::string> taken{"AX", "BL"};  // auxiliary source and black
    std::vector<std::string> reels;
    for (const EditSource& source : list.sources) {
        std::string reel;
        for (const char c : source.reel) {
            const auto byte = static_cast<unsigned char>(c);
            if (byte < 0x80 && std::isalnum(byte) != 0)
                reel += static_cast<char>(std::toupper(byte));
            else if (!reel.empty() && reel.back() != '_')
                reel += '_';
        }
        if (reel.empty()) reel = "REEL";
        reel.resize(std::min(reel.size(), most_letters));
        const std::string wanted = reel;
        for (int n = 2; !taken.insert(reel).second; ++n) {
            const std::string number = std::to_string(n);
            reel = wanted.substr(0, std::min(wanted.size(), most_letters - number.size())) + number;
        }
        reels.push_back(reel);
    }
    return reels;
}

std::string edl_text(const EditList& list) {
    const std::vector<std::string> reels = short_reels(list);
    const auto code = [&](std::int64_t frame) { return list.count.code_of(frame).text(); };
    std::string text = fmt::format("TITLE: {}\nFCM: {}\n", list.name,
                                   list.count.is_drop_frame ? "DROP FRAME" : "NON-DROP FRAME");
    std::int64_t record = first_record_number(list);
    int number = 0;
    for (const EditEvent& event : list.events) {
        const EditSource& source = list.sources[event.source];
        const std::string& reel = reels[event.source];
        text += fmt::format("\n{:03}  {:<8} V     C        {} {} {} {}\n", ++number, reel,
                            code(event.in), code(event.in + event.source_frames()), code(record),
                            code(record + event.frames));
        if (event.speed != 1) {
            // Readers take colons only here, as OpenTimelineIO's does; FCM says what is counted.
            std::string trigger = code(event.in);
            std::ranges::replace(trigger, ';', ':');
            text += fmt::format("M2   {:<8}       {:05.1f}                {}\n", reel,
                                event.speed * list.rate_hz, trigger);
        }
        text += fmt::format("* FROM CLIP NAME: {}\n", event.name);
        if (source.file)
            text += fmt::format("* SOURCE FILE: {}\n", source.file->filename().string());
        if (event.clip > 0)
            text += fmt::format("* LOC: {} GREEN   CLIP {}\n", code(record), event.clip);
        record += event.frames;
    }
    return text;
}

}  // namespace

void write_otio(const EditList& list, const std::filesystem::path& file) {
    write_text_atomically(file, OtioWriter(list).timeline().dump(4) + '\n');
}

void write_edl(const EditList& list, const std::filesystem::path& file) {
    constexpr std::size_t most_events = 999;
    if (list.events.size() > most_events)
        fail(
            "{} is not written: an EDL of the form CMX 3600 has at most {} events, and this list "
            "has {}",
            file.string(), most_events, list.events.size());
    write_text_atomically(file, edl_text(list));
}

}  // namespace vantage
