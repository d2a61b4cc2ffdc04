#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <vector>

#include "common/base/files/kept_file.h"
#include "common/base/time/time.h"
#include "host_app/flight/flight_controller.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/flight/moves/move.h"

namespace vantage {

/// Keeps the shots and the move of a show in a flight file beside the stage file or the take.
/// Changes are written within a second and replace the file that this session read or wrote. A file
/// that another program changed meanwhile, or whose move is replaced by a different one, is kept
/// under a free name. Used on the session's thread only.
class FlightStore {
  public:
    /// Reads the file if it exists. Throws Error as load_flight() does.
    explicit FlightStore(std::filesystem::path file);
    ~FlightStore();
    FlightStore(const FlightStore&) = delete;
    FlightStore& operator=(const FlightStore&) = delete;

    const FlightBook& book() const { return book_; }

    /// To be called if the session starts with another move than the one in the file.
    void begin_with_another_move() { flies_another_ = true; }
    void keep(const FlightController::Change& change);
    /// Simplifies a recorded flight to a move, in the background.
    void simplify(FlightRecording flight, const FlightLimits& limits);
    /// Writes changes that are due; to be called often. Returns a recorded flight that was
    /// simplified since the last call and is now the move of the file.
    std::optional<Move> follow(MonotonicTime now);
    /// Waits for flights that are being simplified and writes all changes.
    void finish();

  private:
    std::optional<Move> take_simplified(bool waits);
    void replace_move(std::optional<Move> move);
    void write();

    KeptFile file_;
    FlightBook book_;
    bool flies_another_ = false;  ///< the session's move is not the one in the file
    bool is_file_move_ = true;    ///< book_ has the file's move or an edited version of it
    std::future<SimplifiedFlight> simplified_;
    std::vector<std::pair<FlightRecording, FlightLimits>> waiting_;
};

/// Name of the flight file: STAGE.flight.toml for STAGE.toml, TAKE.flight.toml for TAKE.mkv.
std::filesystem::path flight_file_of(std::filesystem::path file);

}  // namespace vantage
