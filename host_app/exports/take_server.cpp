#include "host_app/exports/take_server.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/mman.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/base/time/time.h"
#include "common/base/time/timecode.h"
#include "common/geometry/json_rows.h"
#include "common/take/format/frame_storage.h"
#include "host_app/takes/take_show.h"

namespace vantage {
namespace {

using Answer = nlohmann::ordered_json;

/// Arrays in anonymous shared memory, which are laid out first and written then.
class SharedArrays {
  public:
    /// Reserves memory and returns its offset.
    std::size_t reserve(std::size_t bytes) {
        constexpr std::size_t alignment = 64;
        const std::size_t at = (bytes_ + alignment - 1) / alignment * alignment;
        bytes_ = at + bytes;
        return at;
    }
    /// Creates the memory. Throws Error if there is not enough.
    void create() {
        fd_ = UniqueFd(::memfd_create("vantage-frame-set", MFD_CLOEXEC));
        if (!fd_ ||
            ::ftruncate(fd_.get(), static_cast<off_t>(std::max<std::size_t>(bytes_, 1))) != 0)
            refuse();
        void* memory = ::mmap(nullptr, std::max<std::size_t>(bytes_, 1), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_POPULATE, fd_.get(), 0);
        if (memory == MAP_FAILED) refuse();
        memory_ = static_cast<std::byte*>(memory);
    }
    SharedArrays() = default;
    SharedArrays(const SharedArrays&) = delete;
    SharedArrays& operator=(const SharedArrays&) = delete;
    ~SharedArrays() {
        if (memory_) ::munmap(memory_, std::max<std::size_t>(bytes_, 1));
    }

    std::byte* at(std::size_t offset) { return memory_ + offset; }
    std::size_t bytes() const { return bytes_; }
    /// Hands over the descriptor.
    UniqueFd take_fd() { return std::move(fd_); }

  private:
    [[noreturn]] void refuse() const {
        fail("{} bytes of shared memory cannot be had: {}", bytes_, std::strerror(errno));
    }
    std::size_t bytes_ = 0;
    std::byte* memory_ = nullptr;
    UniqueFd fd_;
};

Answer place(std::size_t offset, const cv::Size& size) {
    return {{"offset", offset}, {"height", size.height}, {"width", size.width}};
}

/// Answers the requests of one connection.
class TakeServer {
  public:
    explicit TakeServer(const TakeReader& take)
        : take_(take),
          show_(take_show_from(take.facts().show)),
          codes_(take.facts().pulse_rate_hz) {
        for (const TakeRig& rig : take.facts().rigs) restorers_.emplace_back(rig);
    }

    Answer description() const {
        const TakeFacts& facts = take_.facts();
        Answer rigs = Answer::array();
        std::set<std::uint64_t> pulses;
        for (std::size_t i = 0; i < facts.rigs.size(); ++i) {
            rigs.push_back(facts.rigs[i].name);
            for (const TakeReader::Frame& frame : take_.frames(i)) pulses.insert(frame.pulse);
        }
        return {{"version", 1},
                {"pulse_rate_hz", facts.pulse_rate_hz},
                {"timecode", facts.timecode},
                {"tai_offset_s", facts.tai_offset_s},
                {"program", facts.program},
                {"rigs", rigs},
                {"pulses", pulses},
                {"ticks", take_.cameras().size()}};
    }

    Answer answer(const std::string& line) {
        try {
            const nlohmann::json request = nlohmann::json::parse(line);
            if (request.contains("pulse"))
                return frame_set(request.at("pulse").get<std::uint64_t>());
            if (request.contains("cameras")) return cameras();
            fail("a request has neither pulse nor cameras");
        } catch (const nlohmann::json::exception& error) {
            return {{"error", std::string("a request is no JSON object: ") + error.what()}};
        } catch (const Error& error) {
            return {{"error", error.what()}};
        }
    }

  private:
    Answer frame_set(std::uint64_t pulse) {
        const MonotonicTime start = MonotonicClock::now();
        std::vector<RigFrame> frames;
        Answer damaged = Answer::array();
        for (std::size_t rig = 0; rig < restorers_.size(); ++rig) {
            const auto& all = take_.frames(rig);
            const auto there = std::ranges::lower_bound(all, pulse, {}, &TakeReader::Frame::pulse);
            if (there == all.end() || there->pulse != pulse) continue;
            try {
                RigFrame frame = restorers_[rig].restore(take_.load(rig, *there));
                const auto correction = show_.colours.find(frame.rig);
                if (correction != show_.colours.end() && !correction->second.is_identity() &&
                    !frame.colour.empty())
                    frame.colour = correction->second.apply(frame.colour);
                frames.push_back(std::move(frame));
            } catch (const TakeDamaged& error) {
                damaged.push_back(error.what());
            }
        }
        if (frames.empty() && damaged.empty())
            fail("{} has no frame of pulse {}", take_.path().string(), pulse);
        Answer json{
            {"pulse", pulse},
            {"timecode", codes_.of_pulse(pulse, take_.facts().tai_offset_s)},
            {"damaged", damaged},
            {"decoding_s", std::chrono::duration<double>(MonotonicClock::now() - start).count()},
            {"views", Answer::array()}};
        write(frames, json);
        return json;
    }

    void write(const std::vector<RigFrame>& frames, Answer& json) {
        SharedArrays arrays;
        struct Copy {
            const cv::Mat* from;
            std::size_t to;
        };
        std::vector<Copy> copies;
        const auto add = [&](const cv::Mat& image) -> Answer {
            if (image.empty()) return nullptr;
            copies.push_back({&image, arrays.reserve(image.total() * image.elemSize())});
            return place(copies.back().to, image.size());
        };
        for (const RigFrame& frame : frames) {
            const RectifiedStereo& geometry = frame.geometry;
            json["views"].push_back({{"rig", frame.rig},
                                     {"colour", add(frame.colour)},
                                     {"disparity", add(frame.disparity)},
                                     {"width", geometry.width_px},
                                     {"height", geometry.height_px},
                                     {"K", json_rows(geometry.K_left())},
                                     {"baseline_m", geometry.baseline_m},
                                     {"doffs_px", geometry.doffs_px()},
                                     {"world_from_camera", json_rows(frame.world_from_camera)},
                                     {"calibration", frame.calibration_id},
                                     {"exposure_tai_ns", to_ns(frame.exposure)}});
        }
        arrays.create();
        for (const Copy& copy : copies) {
            cv::Mat to(copy.from->size(), copy.from->type(), arrays.at(copy.to));
            copy.from->copyTo(to);
        }
        hand_over(arrays, json);
    }

    Answer cameras() {
        constexpr std::size_t numbers =
            17;  // tick, pulse, TAI in s, 3x4 pose, field of view, focus
        const std::vector<CameraRecord>& ticks = take_.cameras();
        SharedArrays arrays;
        const std::size_t at = arrays.reserve(ticks.size() * numbers * sizeof(double));
        arrays.create();
        auto* to = reinterpret_cast<double*>(arrays.at(at));
        for (const CameraRecord& tick : ticks) {
            *to++ = static_cast<double>(tick.tick);
            *to++ = static_cast<double>(tick.pulse);
            *to++ = static_cast<double>(to_ns(tick.time)) / 1e9;
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 4; ++column)
                    *to++ = tick.world_from_camera.matrix()(row, column);
            *to++ = tick.field_of_view_rad;
            *to++ = tick.focus_m;
        }
        Answer json{{"cameras", place(at, cv::Size(static_cast<int>(numbers),
                                                   static_cast<int>(ticks.size())))}};
        hand_over(arrays, json);
        return json;
    }

    void hand_over(SharedArrays& arrays, Answer& json) {
        held_ = arrays.take_fd();
        json["fd"] = held_.get();
        json["bytes"] = arrays.bytes();
    }

    const TakeReader& take_;
    TakeShow show_;
    TimecodeClock codes_;
    std::deque<FrameRestorer> restorers_;
    UniqueFd held_;  ///< of the latest answer
};

}  // namespace

void serve_take(const TakeReader& take, std::istream& in, std::ostream& out) {
    TakeServer server(take);
    out << server.description().dump() << std::endl;
    for (std::string line; std::getline(in, line);) out << server.answer(line).dump() << std::endl;
}

}  // namespace vantage
