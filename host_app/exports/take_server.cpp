#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <iostream>
#include <list>
#include <memory>
#include <ranges>
#include <set>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>
#include <sys/mman.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/base/time/time.h"
#include "common/base/time/timecode.h"
#include "common/geometry/json_rows.h"
#include "common/take/format/frame_storage.h"
#include "host_app/exports/take_export.h"
#include "host_app/takes/take_show.h"

namespace vantage {
namespace {

using Answer = nlohmann::ordered_json;

/// Anonymous shared memory that the other program maps.
class SharedMemory {
  public:
    /// Throws Error if there is not enough.
    explicit SharedMemory(std::size_t bytes)
        : bytes_(std::max<std::size_t>(bytes, 1)),
          fd_(::memfd_create("vantage-frame-set", MFD_CLOEXEC)) {
        if (!fd_ || ::ftruncate(fd_.get(), static_cast<off_t>(bytes_)) != 0) refuse();
        void* memory = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE,
                              fd_.get(), 0);
        if (memory == MAP_FAILED) refuse();
        memory_ = static_cast<std::byte*>(memory);
    }
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;
    ~SharedMemory() { ::munmap(memory_, bytes_); }

    std::byte* at(std::size_t offset) { return memory_ + offset; }
    std::size_t bytes() const { return bytes_; }
    int fd() const { return fd_.get(); }

  private:
    [[noreturn]] void refuse() const {
        fail("{} bytes of shared memory cannot be had: {}", bytes_, std::strerror(errno));
    }
    std::size_t bytes_;
    UniqueFd fd_;
    std::byte* memory_ = nullptr;
};

/// The places of arrays in one block of memory.
class ArrayLayout {
  public:
    /// Reserves memory and returns its offset.
    std::size_t reserve(std::size_t bytes) {
        constexpr std::size_t alignment = 64;
        const std::size_t at = (bytes_ + alignment - 1) / alignment * alignment;
        bytes_ = at + bytes;
        return at;
    }
    std::size_t bytes() const { return bytes_; }

  private:
    std::size_t bytes_ = 0;
};

/// Shared memory of the latest answers. What the other program has released is used again: the
/// system gives new memory page by page, which takes about as long as a copy.
class SharedMemoryPool {
  public:
    /// The number of the returned memory. Older memory is forgotten if too much is lent; a mapping
    /// of it stays valid.
    std::pair<std::uint64_t, SharedMemory*> take(std::size_t bytes) {
        const auto released = std::ranges::find_if(blocks_, [&](const Block& block) {
            return !block.is_lent && block.memory->bytes() == bytes;
        });
        if (released != blocks_.end()) {
            blocks_.splice(blocks_.end(), blocks_, released);
            blocks_.back().is_lent = true;
        } else {
            constexpr std::size_t most_kept = 4;
            while (blocks_.size() >= most_kept) blocks_.pop_front();
            blocks_.push_back({next_++, std::make_unique<SharedMemory>(bytes), true});
        }
        return {blocks_.back().number, blocks_.back().memory.get()};
    }
    void release(std::uint64_t number) {
        for (Block& block : blocks_)
            if (block.number == number) block.is_lent = false;
    }

  private:
    struct Block {
        std::uint64_t number;
        std::unique_ptr<SharedMemory> memory;
        bool is_lent;
    };
    std::list<Block> blocks_;  ///< in the order of their last use
    std::uint64_t next_ = 0;
};

std::size_t bytes_of(const cv::Size& size, std::size_t pixel_bytes) {
    return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) *
           pixel_bytes;
}

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
        for (const TakeRig& rig : take.facts().rigs) rigs_.emplace_back(rig, layout_);
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
            if (request.contains("released"))
                for (const nlohmann::json& number : request.at("released"))
                    pool_.release(number.get<std::uint64_t>());
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
    /// How the frames of one rig are decoded, and where to in the memory of a frame set.
    struct Rig {
        Rig(const TakeRig& rig, ArrayLayout& layout)
            : restorer(rig),
              colour_px(rig.colour.size_px),
              disparity_px(rig.depth.size_px),
              colour_at(layout.reserve(bytes_of(colour_px, sizeof(cv::Vec4b)))),
              disparity_at(layout.reserve(bytes_of(disparity_px, sizeof(std::uint16_t)))) {}

        FrameRestorer restorer;
        cv::Size colour_px, disparity_px;
        std::size_t colour_at, disparity_at;
    };

    Answer frame_set(std::uint64_t pulse) {
        const auto has_pulse = [&](std::size_t rig) {
            return std::ranges::binary_search(take_.frames(rig), pulse, {},
                                              &TakeReader::Frame::pulse);
        };
        if (std::ranges::none_of(std::views::iota(std::size_t{0}, rigs_.size()), has_pulse))
            fail("{} has no frame of pulse {}", take_.path().string(), pulse);
        const auto [number, memory] = pool_.take(layout_.bytes());
        const MonotonicTime start = MonotonicClock::now();
        Answer views = Answer::array(), damaged = Answer::array();
        for (std::size_t rig = 0; rig < rigs_.size(); ++rig) {
            if (!has_pulse(rig)) continue;
            try {
                views.push_back(view(rig, pulse, *memory));
            } catch (const TakeDamaged& error) {
                damaged.push_back(error.what());
            }
        }
        Answer json{
            {"pulse", pulse},
            {"timecode", codes_.of_pulse(pulse, take_.facts().tai_offset_s)},
            {"damaged", damaged},
            {"decoding_s", std::chrono::duration<double>(MonotonicClock::now() - start).count()},
            {"views", views}};
        hand_over(number, *memory, json);
        return json;
    }

    Answer view(std::size_t rig_number, std::uint64_t pulse, SharedMemory& memory) {
        Rig& rig = rigs_[rig_number];
        FrameMemory images;
        if (!rig.colour_px.empty())
            images.colour = ColourImage(rig.colour_px.height, rig.colour_px.width,
                                        reinterpret_cast<cv::Vec4b*>(memory.at(rig.colour_at)));
        if (!rig.disparity_px.empty())
            images.disparity =
                DisparityImage(rig.disparity_px.height, rig.disparity_px.width,
                               reinterpret_cast<std::uint16_t*>(memory.at(rig.disparity_at)));
        const auto there = std::ranges::lower_bound(take_.frames(rig_number), pulse, {},
                                                    &TakeReader::Frame::pulse);
        const RigFrame frame = rig.restorer.restore(take_.load(rig_number, *there), images);
        const auto correction = show_.colours.find(frame.rig);
        if (correction != show_.colours.end() && !correction->second.is_identity() &&
            !frame.colour.empty())
            correction->second.apply(frame.colour).copyTo(images.colour);
        const auto place_of = [](std::size_t at, const cv::Mat& image) {
            return image.empty() ? Answer() : place(at, image.size());
        };
        const RectifiedStereo& geometry = frame.geometry;
        return {{"rig", frame.rig},
                {"colour", place_of(rig.colour_at, frame.colour)},
                {"disparity", place_of(rig.disparity_at, frame.disparity)},
                {"width", geometry.width_px},
                {"height", geometry.height_px},
                {"K", json_rows(geometry.K_left())},
                {"baseline_m", geometry.baseline_m},
                {"doffs_px", geometry.doffs_px()},
                {"world_from_camera", json_rows(frame.world_from_camera)},
                {"calibration", frame.calibration_id},
                {"exposure_tai_ns", to_ns(frame.exposure)}};
    }

    Answer cameras() {
        constexpr std::size_t numbers =
            17;  // tick, pulse, TAI in s, 3x4 pose, field of view, focus
        const std::vector<CameraRecord>& ticks = take_.cameras();
        const auto [number, memory] = pool_.take(ticks.size() * numbers * sizeof(double));
        auto* to = reinterpret_cast<double*>(memory->at(0));
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
        Answer json{{"cameras", place(0, cv::Size(static_cast<int>(numbers),
                                                  static_cast<int>(ticks.size())))}};
        hand_over(number, *memory, json);
        return json;
    }

    static void hand_over(std::uint64_t number, const SharedMemory& memory, Answer& json) {
        json["memory"] = number;
        json["fd"] = memory.fd();
        json["bytes"] = memory.bytes();
    }

    const TakeReader& take_;
    TakeShow show_;
    TimecodeClock codes_;
    ArrayLayout layout_;  ///< of a frame set of all rigs
    std::deque<Rig> rigs_;
    SharedMemoryPool pool_;
};

}  // namespace

void serve_take(const TakeReader& take, std::istream& in, std::ostream& out) {
    TakeServer server(take);
    out << server.description().dump() << std::endl;
    for (std::string line; std::getline(in, line);) out << server.answer(line).dump() << std::endl;
}

}  // namespace vantage
