#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace vantage {

/// Reference counting of one camera's buffers. A buffer goes back to its driver when the last copy
/// of its lease is gone, on whichever thread. A lease may outlive the lender: its memory stays
/// valid, and the driver is not called.
class BufferLender {
  public:
    /// Smallest number of buffers that allows lending. With fewer, the driver would run out while
    /// some are in the pipeline.
    static constexpr unsigned least_buffers = 5;
    static constexpr unsigned wanted_buffers = 6;

    /// `give_back` receives the index of a buffer and must not throw.
    explicit BufferLender(std::function<void(unsigned)> give_back)
        : desk_(std::make_shared<Desk>(std::move(give_back))) {}
    ~BufferLender() { close(); }
    BufferLender(const BufferLender&) = delete;
    BufferLender& operator=(const BufferLender&) = delete;

    /// `memory` lives as long as the lease.
    std::shared_ptr<const void> lend(unsigned index, std::shared_ptr<const void> memory) {
        struct Lease {
            std::shared_ptr<Desk> desk;
            unsigned index;
            std::shared_ptr<const void> memory;
            Lease(std::shared_ptr<Desk> d, unsigned i, std::shared_ptr<const void> m)
                : desk(std::move(d)), index(i), memory(std::move(m)) {}
            Lease(const Lease&) = delete;
            Lease& operator=(const Lease&) = delete;
            ~Lease() {
                const std::lock_guard lock(desk->mutex);
                if (desk->give_back) desk->give_back(index);
            }
        };
        return std::make_shared<const Lease>(desk_, index, std::move(memory));
    }

    /// Identifies this camera in LentPicture.
    std::shared_ptr<const void> identity() const { return desk_; }

    /// Stops returning buffers to the driver.
    void close() {
        const std::lock_guard lock(desk_->mutex);
        desk_->give_back = nullptr;
    }

  private:
    struct Desk {
        explicit Desk(std::function<void(unsigned)> g) : give_back(std::move(g)) {}
        std::mutex mutex;
        std::function<void(unsigned)> give_back;
    };
    std::shared_ptr<Desk> desk_;
};

}  // namespace vantage
