#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/receive/frame_set.h"
#include "host_app/flight/corridor.h"

namespace vantage {

/// The positions of the stage's rigs.
struct StagePlaces {
    struct Rig {
        std::string name;
        CorridorRig rig;
        bool is_away = false;
    };
    std::vector<Rig> rigs;
    StageExtent extent;
};

/// The corridor of the rigs that send frames now. A rig is away after two seconds without a frame,
/// unless this host requested none of it; it returns with its next frame.
class StageCorridor {
  public:
    /// `aspect` is height divided by width of the programme's picture.
    explicit StageCorridor(double aspect) : aspect_(aspect) {}

    /// Sets the extent of the stage. Without it update() does nothing.
    void begin(const StageExtent& extent) { extent_ = extent; }
    /// Takes a frame set; frame sets come in the order of time, and may repeat.
    void update(const FrameSet& set);
    /// The corridor; null before the first update(). From any thread.
    std::shared_ptr<const Corridor> now() const;
    /// The rigs of that corridor; nothing without one. From any thread.
    std::optional<StagePlaces> places() const;

  private:
    struct Rig {
        CorridorRig rig;
        MonotonicTime seen{};
        bool is_away = false;
    };
    double aspect_;
    std::optional<StageExtent> extent_;
    std::map<std::string, Rig> rigs_;
    std::optional<MonotonicTime> updated_;  ///< time of the last frame set
    mutable std::mutex mutex_;
    std::shared_ptr<const Corridor> now_;
    std::optional<StagePlaces> places_;
};

}  // namespace vantage
