#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/base/bounded_queue.h"
#include "common/base/time/time.h"
#include "host_app/control/hid/jog_bus.h"
#include "host_app/control/hid/wheel_profile.h"

namespace vantage {

/// What happened at the desk.
struct DeckEvent {
    enum class Kind {
        plugged,  ///< the device can be used from now on
        lost,     ///< it is gone; nothing of it is held any more
        control,  ///< `event`
        unread,   ///< a report that its decoder does not know
        report,   ///< any report, where raw reports were asked for
    };
    Kind kind = Kind::control;
    std::string path;  ///< of the device's node
    std::shared_ptr<const WheelProfile> profile;
    JogEvent event;
    std::vector<std::uint8_t> report;
    MonotonicTime time{};  ///< when the report was read
};

struct DeckDevice {
    JogPlace place;
    std::string model;
    bool usable = false;
    std::string fault;  ///< why it is not
    std::uint64_t reports = 0, unread = 0;
};

/// The jog controllers of this computer: finds them as they are plugged in, reads each on a thread
/// of its own, and notices when one goes. A device that may not be opened, or that does not start,
/// is tried again and again, since its permissions may come a moment after its node; so is a bus
/// that cannot be listed.
class JogDevices {
  public:
    struct Options {
        bool raw_reports = false;
        std::chrono::milliseconds look_every{500};
    };
    JogDevices(std::unique_ptr<JogBus> bus, std::vector<WheelProfile> profiles, Options options);
    JogDevices(std::unique_ptr<JogBus> bus, std::vector<WheelProfile> profiles)
        : JogDevices(std::move(bus), std::move(profiles), Options()) {}
    ~JogDevices();
    JogDevices(const JogDevices&) = delete;
    JogDevices& operator=(const JogDevices&) = delete;

    /// The oldest event that was not taken; waits for one until the time is up.
    std::optional<DeckEvent> next(std::chrono::nanoseconds timeout = std::chrono::nanoseconds(0));
    /// Events that had to make room because nobody took them.
    std::uint64_t dropped() const { return events_.dropped_count(); }

    /// What is plugged in and could be used, as of the last look.
    std::vector<DeckDevice> devices() const;

  private:
    class Reader;
    /// A node that could be used, as the looking thread knows it.
    struct Seen {
        DeckDevice device;
        std::shared_ptr<const WheelProfile> profile;
        std::unique_ptr<Reader> reader;
        int failures = 0;
        MonotonicTime next_try{};
    };

    void run();
    void look(std::map<std::string, Seen>& seen);
    void care_for(Seen& seen);
    void note_failure(Seen& seen, const std::string& fault);
    void push(DeckEvent event) { events_.push(std::move(event)); }

    std::unique_ptr<JogBus> bus_;
    std::vector<WheelProfile> profiles_;
    Options options_;
    BoundedQueue<DeckEvent> events_{4096};
    BoundedQueue<int> end_{1};  ///< closed: the looking thread ends
    mutable std::mutex mutex_;  ///< of devices_
    std::vector<DeckDevice> devices_;
    std::thread thread_;
};

/// The node, the family and the profile of every device that can be read; without a profile there
/// is nothing that it would do. Of a node with several collections only the one that speaks.
struct ReadableJog {
    JogPlace place;
    std::string model;
    const WheelProfile* profile = nullptr;
};
std::vector<ReadableJog> readable_jogs(const std::vector<JogPlace>& places,
                                       const std::vector<WheelProfile>& profiles);
/// A decoder for such a device.
std::unique_ptr<JogDecoder> make_decoder(const WheelProfile& profile, JogId id);

}  // namespace vantage
