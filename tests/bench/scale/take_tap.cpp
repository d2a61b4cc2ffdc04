// Notes what rigs send, as another host of theirs, and holds a take against it: nothing of what
// records takes has a part in the notes.
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "common/base/cli/stop_signal.h"
#include "common/base/error.h"
#include "common/config/stage_config.h"
#include "common/receive/stage_receiver.h"
#include "common/take/format/frame_storage.h"
#include "common/take/take_reader.h"

namespace vantage {
namespace {

std::uint32_t pixels_crc(const DisparityImage& disparity) {
    const cv::Mat whole = disparity.isContinuous() ? cv::Mat(disparity) : disparity.clone();
    return crc32(
        {reinterpret_cast<const std::byte*>(whole.data), whole.total() * whole.elemSize()});
}

/// A line a frame: rig, session, pulse, CRC-32 of header, of colour as it came, and of disparity.
void note(const std::string& stage_file, const std::string& notes) {
    const StageConfig stage = load_stage_config(stage_file);
    StopSignal stop;
    std::mutex mutex;
    std::ofstream out(notes);
    if (!out) fail("{} cannot be written", notes);
    std::vector<DisparityDecoder> decoders(stage.rigs.size());
    const StageReceiver receiver(
        stage, StageReceiver::Purpose::film, [&](const ArrivedFrame& frame) {
            const FrameHead head = decode_frame_head(frame.packed->header);
            const std::lock_guard lock(mutex);
            const DisparityImage disparity = decoders[frame.rig].decode(
                frame.packed->disparity, head.disparity_px.width, head.disparity_px.height);
            out << head.frame.rig << ' ' << head.frame.session << ' ' << head.frame.trigger_index
                << ' ' << crc32(frame.packed->header) << ' ' << crc32(frame.packed->colour) << ' '
                << pixels_crc(disparity) << std::endl;
        });
    while (!stop.wait_for(std::chrono::milliseconds(100))) {
    }
}

struct Note {
    std::uint64_t session = 0;
    std::uint32_t header = 0, colour = 0, disparity = 0;
    bool operator==(const Note&) const = default;
};

int compare(const std::string& take_file, const std::string& notes, bool all) {
    std::map<std::string, std::map<std::uint64_t, Note>> noted;
    std::ifstream in(notes);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string rig;
        std::uint64_t pulse = 0;
        Note note;
        if (words >> rig >> note.session >> pulse >> note.header >> note.colour >> note.disparity)
            noted[rig][pulse] = note;
    }
    const TakeReader take(take_file);
    std::cout << "| rig | frames of the take | noted too | that differ | noted and not in the take "
                 "| starts of the rig |\n| --- | --- | --- | --- | --- | --- |\n";
    bool is_same = !noted.empty();
    for (std::size_t rig = 0; rig < take.facts().rigs.size(); ++rig) {
        const std::string& name = take.facts().rigs[rig].name;
        FrameRestorer restorer(take.facts().rigs[rig]);
        std::size_t compared = 0, differing = 0, lacking = 0;
        std::set<std::uint64_t> sessions;
        std::map<std::uint64_t, bool> there;
        for (const TakeReader::Frame& frame : take.frames(rig)) {
            there[frame.pulse] = true;
            sessions.insert(frame.session);
            const auto found = noted[name].find(frame.pulse);
            if (found == noted[name].end()) continue;
            ++compared;
            const StoredFrame stored = take.load(rig, frame);
            const Note here{frame.session, crc32(stored.record.header), crc32(stored.colour),
                            pixels_crc(restorer.restore(stored).disparity)};
            differing += here != found->second;
        }
        if (take.frames(rig).empty()) continue;
        for (const auto& [pulse, note] : noted[name])
            lacking += pulse >= take.frames(rig).front().pulse &&
                       pulse <= take.frames(rig).back().pulse && !there.contains(pulse);
        std::cout << fmt::format("| {} | {} | {} | {} | {} | {} |\n", name, take.frames(rig).size(),
                                 compared, differing, lacking, sessions.size());
        is_same = is_same && differing == 0 && compared > 0 && !(all && lacking > 0);
    }
    return is_same ? 0 : 1;
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    using namespace vantage;
    CLI::App app("What rigs send, noted by another host of theirs, against a take");
    app.require_subcommand(1);
    std::string stage, notes, take;
    CLI::App* noting = app.add_subcommand("note", "Until SIGTERM");
    noting->add_option("--stage", stage)->required();
    noting->add_option("-o,--output", notes, "A line a frame")->required();
    CLI::App* comparing = app.add_subcommand("compare", "Ends with 1 if a frame differs");
    comparing->add_option("TAKE", take)->required();
    comparing->add_option("NOTES", notes)->required();
    bool all = false;
    comparing->add_flag("--all", all, "Also if a noted frame is not in the take");
    CLI11_PARSE(app, argc, argv);
    try {
        if (comparing->parsed()) return compare(take, notes, all);
        note(stage, notes);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "take_tap: " << error.what() << "\n";
        return 1;
    }
}
