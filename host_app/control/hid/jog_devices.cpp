#include "host_app/control/hid/jog_devices.h"

#include <algorithm>
#include <atomic>
#include <set>
#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"
#include "common/base/trace/trace.h"

namespace vantage {
namespace {

/// Longest wait of a reader: how fast it notices a stop, and how often a decoder keeps its device
/// alive.
constexpr std::chrono::milliseconds patience{100};
/// Longest interval between two attempts to open a device that refuses.
constexpr std::chrono::seconds slowest_retry{5};

}  // namespace

std::vector<ReadableJog> readable_jogs(const std::vector<JogPlace>& places,
                                       const std::vector<WheelProfile>& profiles) {
    const std::vector<JogFamily> families = jog_families();
    std::vector<ReadableJog> readable;
    std::set<std::string> nodes;
    for (const JogPlace& place : places) {
        const WheelProfile* profile = find_profile(profiles, place.id);
        if (!profile || nodes.contains(place.path)) continue;
        std::string model = profile->name;
        if (profile->report.empty()) {
            const auto family =
                std::find_if(families.begin(), families.end(),
                             [&](const JogFamily& candidate) { return reads(candidate, place); });
            if (family == families.end()) continue;
            for (const JogModel& known : family->models)
                if (known.id == place.id) model = known.name;
        } else if (place.transport != JogTransport::hidraw) {
            continue;
        }
        nodes.insert(place.path);
        readable.push_back({place, model, profile});
    }
    return readable;
}

std::unique_ptr<JogDecoder> make_decoder(const WheelProfile& profile, JogId id) {
    if (!profile.report.empty()) return make_described_decoder(profile.report);
    if (std::unique_ptr<JogDecoder> decoder = make_known_decoder(id)) return decoder;
    fail("Vantage cannot read {} by itself: describe its reports with [[report]] tables",
         to_text(id));
}

/// One open device and the thread that reads it.
class JogDevices::Reader {
  public:
    Reader(JogDevices& deck, const Seen& seen, std::unique_ptr<JogPort> port)
        : deck_(deck),
          name_(seen.device.model),
          path_(seen.device.place.path),
          profile_(seen.profile),
          port_(std::move(port)),
          decoder_(make_decoder(*seen.profile, seen.device.place.id)),
          thread_([this] { run(); }) {}
    ~Reader() {
        stopping_ = true;
        thread_.join();
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    bool usable() const { return usable_ && !gone_; }
    bool gone() const { return gone_; }
    /// Precondition: gone().
    const std::string& fault() const { return fault_; }
    /// True if the device ever worked.
    bool was_usable() const { return usable_; }
    std::uint64_t reports() const { return reports_; }
    std::uint64_t unread() const { return unread_; }

  private:
    void run() {
        try {
            decoder_->start(*port_, MonotonicClock::now());
            usable_ = true;
            log_info("{} at {} is ready", name_, path_);
            push(DeckEvent::Kind::plugged);
            while (!stopping_) read_one();
        } catch (const std::exception& error) {
            fault_ = error.what();
        }
        if (usable_ && !stopping_) log_warning("{}; what it drove holds until it is back", fault_);
        if (usable_) push(DeckEvent::Kind::lost);
        gone_ = true;
    }

    void read_one() {
        const std::vector<std::uint8_t> report = port_->read(patience);
        if (!report.empty()) take(report, MonotonicClock::now());
        decoder_->keep_alive(*port_, MonotonicClock::now());
    }

    void take(const std::vector<std::uint8_t>& report, MonotonicTime now) {
        TraceSpan span("wheel report");
        span.in(TraceId::of_input(now), TraceFlow::begins);
        ++reports_;
        if (deck_.options_.raw_reports) push(DeckEvent::Kind::report, report, now);
        std::vector<JogEvent> events;
        if (!decoder_->decode(report, events)) {
            ++unread_;
            push(DeckEvent::Kind::unread, report, now);
        }
        for (JogEvent& event : events)
            deck_.push({DeckEvent::Kind::control, path_, profile_, std::move(event), {}, now});
    }

    void push(DeckEvent::Kind kind, std::vector<std::uint8_t> report = {},
              MonotonicTime time = MonotonicClock::now()) {
        deck_.push({kind, path_, profile_, {}, std::move(report), time});
    }

    JogDevices& deck_;
    std::string name_, path_, fault_;
    std::shared_ptr<const WheelProfile> profile_;
    std::unique_ptr<JogPort> port_;
    std::unique_ptr<JogDecoder> decoder_;
    std::atomic<bool> stopping_ = false, usable_ = false, gone_ = false;
    std::atomic<std::uint64_t> reports_ = 0, unread_ = 0;
    std::thread thread_;
};

JogDevices::JogDevices(std::unique_ptr<JogBus> bus, std::vector<WheelProfile> profiles,
                       Options options)
    : bus_(std::move(bus)),
      profiles_(std::move(profiles)),
      options_(options),
      thread_([this] { run(); }) {}

JogDevices::~JogDevices() {
    end_.close();
    thread_.join();
}

std::optional<DeckEvent> JogDevices::next(std::chrono::nanoseconds timeout) {
    return events_.pop_for(timeout);
}

std::vector<DeckDevice> JogDevices::devices() const {
    const std::lock_guard lock(mutex_);
    return devices_;
}

void JogDevices::run() {
    name_this_thread("jog");
    // The readers push to this object, so that they end before it does.
    std::map<std::string, Seen> seen;
    bool is_told = false;
    while (!end_.closed()) {
        try {
            look(seen);
            is_told = false;
        } catch (const std::exception& error) {
            // Open devices are still read; plugging and unplugging is noticed later.
            if (!std::exchange(is_told, true))
                log_warning("jog wheels are looked for again and again: {}", error.what());
        }
        end_.pop_for(options_.look_every);
    }
}

void JogDevices::look(std::map<std::string, Seen>& seen) {
    const std::vector<ReadableJog> there = readable_jogs(bus_->list(), profiles_);
    std::erase_if(seen, [&](const auto& entry) {
        return std::none_of(there.begin(), there.end(), [&](const ReadableJog& jog) {
            return jog.place.path == entry.first && jog.place.id == entry.second.device.place.id;
        });
    });
    for (const ReadableJog& jog : there) {
        const auto [entry, is_new] = seen.try_emplace(jog.place.path);
        if (is_new) {
            entry->second.device = {jog.place, jog.model, false, {}, 0, 0};
            entry->second.profile = std::make_shared<const WheelProfile>(*jog.profile);
        }
        care_for(entry->second);
    }
    std::vector<DeckDevice> devices;
    for (const auto& [path, one] : seen) {
        devices.push_back(one.device);
        if (!one.reader) continue;
        devices.back().usable = one.reader->usable();
        if (devices.back().usable) devices.back().fault.clear();
        devices.back().reports = one.reader->reports();
        devices.back().unread = one.reader->unread();
    }
    const std::lock_guard lock(mutex_);
    devices_ = std::move(devices);
}

void JogDevices::care_for(Seen& seen) {
    if (seen.reader && !seen.reader->gone()) {
        if (seen.reader->usable()) {
            seen.failures = 0;
            seen.device.fault.clear();
        }
        return;
    }
    if (seen.reader) {
        const std::string fault = seen.reader->fault();
        const bool was_usable = seen.reader->was_usable();
        seen.reader.reset();
        if (!was_usable) note_failure(seen, fault);
    }
    if (MonotonicClock::now() < seen.next_try) return;
    try {
        seen.reader = std::make_unique<Reader>(*this, seen, bus_->open(seen.device.place));
    } catch (const Error& error) {
        note_failure(seen, error.what());
    }
}

void JogDevices::note_failure(Seen& seen, const std::string& fault) {
    seen.device.fault = fault;
    ++seen.failures;
    // At the first failure udev may not have set the node's permissions yet.
    if (seen.failures == 2) log_warning("{}", fault);
    seen.next_try = MonotonicClock::now() + std::min<std::chrono::nanoseconds>(
                                                seen.failures * options_.look_every, slowest_retry);
}

}  // namespace vantage
