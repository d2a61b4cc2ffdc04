#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "host_app/control/hid/jog_devices.h"

namespace vantage {

using Bytes = std::vector<std::uint8_t>;

/// What a test plugs in: it sends the reports it is told to and keeps what it is sent.
class ScriptedDevice {
  public:
    explicit ScriptedDevice(JogPlace at) : place(std::move(at)) {}

    void send(Bytes report) {
        {
            const std::lock_guard lock(mutex_);
            reports_.push_back(std::move(report));
        }
        changed_.notify_all();
    }
    void break_off() {
        {
            const std::lock_guard lock(mutex_);
            gone_ = true;
        }
        changed_.notify_all();
    }

    Bytes read(std::chrono::milliseconds timeout) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, timeout, [&] { return gone_ || !reports_.empty(); });
        if (!reports_.empty()) {
            Bytes report = std::move(reports_.front());
            reports_.pop_front();
            return report;
        }
        if (gone_) fail("{} is gone", place.name);
        return {};
    }

    JogPlace place;
    std::string refusal;  ///< of whoever opens it; empty: it can be opened

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Bytes> reports_;
    bool gone_ = false;
};

class ScriptedPort final : public JogPort {
  public:
    explicit ScriptedPort(std::shared_ptr<ScriptedDevice> device) : device_(std::move(device)) {}
    Bytes read(std::chrono::milliseconds timeout) override { return device_->read(timeout); }
    void write(std::span<const std::uint8_t>) override {}
    void send_feature(std::span<const std::uint8_t>) override {}
    Bytes get_feature(std::uint8_t, std::size_t) override { return {}; }

  private:
    std::shared_ptr<ScriptedDevice> device_;
};

/// The sockets of a pretended computer; the test plugs in and out while a deck looks.
class ScriptedSockets {
  public:
    void plug(std::shared_ptr<ScriptedDevice> device) {
        const std::lock_guard lock(mutex_);
        devices_.push_back(std::move(device));
    }
    void unplug(const std::shared_ptr<ScriptedDevice>& device) {
        {
            const std::lock_guard lock(mutex_);
            std::erase(devices_, device);
        }
        device->break_off();
    }
    void allow(const std::shared_ptr<ScriptedDevice>& device) {
        const std::lock_guard lock(mutex_);
        device->refusal.clear();
    }
    void stop_listing(std::string sentence) {
        const std::lock_guard lock(mutex_);
        failure_ = std::move(sentence);
    }
    void list_again() { stop_listing({}); }
    /// Times that a listing failed so far.
    int failed_listings() {
        const std::lock_guard lock(mutex_);
        return failed_listings_;
    }

    std::unique_ptr<JogBus> bus() { return std::make_unique<Bus>(*this); }

  private:
    class Bus final : public JogBus {
      public:
        explicit Bus(ScriptedSockets& sockets) : sockets_(sockets) {}
        std::vector<JogPlace> list() override {
            const std::lock_guard lock(sockets_.mutex_);
            if (!sockets_.failure_.empty()) {
                ++sockets_.failed_listings_;
                throw Error(sockets_.failure_);
            }
            std::vector<JogPlace> places;
            for (const auto& device : sockets_.devices_) places.push_back(device->place);
            return places;
        }
        std::unique_ptr<JogPort> open(const JogPlace& place) override {
            const std::lock_guard lock(sockets_.mutex_);
            for (const auto& device : sockets_.devices_) {
                if (device->place.path != place.path) continue;
                if (!device->refusal.empty()) throw Error(device->refusal);
                return std::make_unique<ScriptedPort>(device);
            }
            fail("nothing is at {}", place.path);
        }

      private:
        ScriptedSockets& sockets_;
    };

    std::mutex mutex_;
    std::vector<std::shared_ptr<ScriptedDevice>> devices_;
    std::string failure_;
    int failed_listings_ = 0;
};

}  // namespace vantage
