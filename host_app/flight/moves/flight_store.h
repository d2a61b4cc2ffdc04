#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <vector>

#include "common/base/files/kept_file.h"
#include "common/base/time/time.h"
#include "host_app/flight/flight_book.h"
#include "host_app/flight/flight_controller.h"
#include "host_app/flight/moves/flight_recording.h"

namespace vantage {

/// Keeps a show's shots and its move in a flight file, beside the stage's or the take's. What hands
/// change is written within a second, in place of what this session read or wrote; a file that
/// anybody else has changed meanwhile, or whose move makes room for another one, stays under a free
/// name. Of the session's thread.
class FlightStore {
  public:
    /// Reads the file where there is one. Throws Error as load_flight().
    explicit FlightStore(std::filesystem::path file);
    ~FlightStore();
    FlightStore(const FlightStore&) = delete;
    FlightStore& operator=(const FlightStore&) = delete;

    const FlightBook& book() const { return book_; }

    /// The session begins with another move than the file's.
    void begin_with_another_move() { flies_another_ = true; }
    void keep(const FlightController::Change& change);
    /// Makes a move of a flight that was recorded, meanwhile.
    void simplify(FlightRecording flight, const FlightLimits& limits);
    /// To be called often: writes what is due. A flight that has become a move since the last call;
    /// it is kept.
    std::optional<Move> follow(MonotonicTime now);
    /// Writes all that is not written yet; waits for flights.
    void finish();

  private:
    std::optional<Move> take_simplified(bool waits);
    void replace_move(std::optional<Move> move);
    void write();

    KeptFile file_;
    FlightBook book_;
    bool flies_another_ = false;  ///< than the file's move
    bool is_file_move_ = true;    ///< what is to be written has the file's move, as hands made it
    std::future<SimplifiedFlight> simplified_;
    std::vector<std::pair<FlightRecording, FlightLimits>> waiting_;
};

/// STAGE.flight.toml beside STAGE.toml, TAKE.flight.toml beside TAKE.mkv.
std::filesystem::path flight_file_of(std::filesystem::path file);

}  // namespace vantage
