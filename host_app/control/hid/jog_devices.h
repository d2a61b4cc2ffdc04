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
#include "host_app/control/hid/jog_family.h"
#include "host_app/control/hid/wheel_profile.h"

namespace vantage {

/// Interface of the system's bus on which controllers are plugged in.
class JogBus {
  public:
    virtual ~JogBus() = default;

    /// Lists all nodes that exist now, of any device. A node with several collections is listed
    /// once for each.
    virtual std::vector<JogPlace> list() = 0;
    /// Opens a node. Throws Error; if this user may not open it, the message names the udev rule
    /// that permits it.
    virtual std::unique_ptr<JogPort> open(const JogPlace& place) = 0;
};

/// Creates the bus of this computer: hidraw through hidapi, and evdev. Use it from one thread; each
/// port that it opens may be used on another.
std::unique_ptr<JogBus> make_system_jog_bus();

/// Event of a controller: plugged in, lost, or operated.
struct DeckEvent {
    enum class Kind {
        plugged,  ///< the device is ready
        lost,     ///< it is gone, and all its controls count as released
        control,  ///< `event`
        unread,   ///< a report that its decoder does not understand
        report,   ///< any report, if raw reports are enabled
    };
    Kind kind = Kind::control;
    std::string path;  ///< of the device's node
    std::shared_ptr<const WheelProfile> profile;
    JogEvent event;
    std::vector<std::uint8_t> report;
    MonotonicTime time{};  ///< time at which the report was read
};

struct DeckDevice {
    JogPlace place;
    std::string model;
    bool usable = false;
    std::string fault;  ///< reason why the device is not usable
    std::uint64_t reports = 0, unread = 0;
};

/// All jog controllers of this computer. It finds them as they are plugged in, reads each on a
/// thread of its own, and notices when one is unplugged. A device that cannot be opened or does not
/// start is tried again, since its permissions may arrive shortly after its node; a bus that cannot
/// be listed is tried again too. Thread-safe.
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

    /// Removes and returns the oldest event; waits for one up to `timeout`.
    std::optional<DeckEvent> next(std::chrono::nanoseconds timeout = std::chrono::nanoseconds(0));
    /// Number of events that were dropped because the queue was full.
    std::uint64_t dropped() const { return events_.dropped_count(); }

    /// Devices that were plugged in and usable at the last scan.
    std::vector<DeckDevice> devices() const;

  private:
    class Reader;
    /// State of a node that may be usable, owned by the scanning thread.
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
    BoundedQueue<int> end_{1};  ///< closed to end the scanning thread
    mutable std::mutex mutex_;  ///< guards devices_
    std::vector<DeckDevice> devices_;
    std::thread thread_;
};

/// Device that can be read: its node, its family and its profile. A device without a profile would
/// do nothing and is left out. Of a node with several collections only the one that sends events is
/// listed.
struct ReadableJog {
    JogPlace place;
    std::string model;
    const WheelProfile* profile = nullptr;
};
std::vector<ReadableJog> readable_jogs(const std::vector<JogPlace>& places,
                                       const std::vector<WheelProfile>& profiles);
/// Creates a decoder for a device of this profile.
std::unique_ptr<JogDecoder> make_decoder(const WheelProfile& profile, JogId id);

}  // namespace vantage
