#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/base/files/kept_file.h"

namespace vantage {

/// The viewpoint of the desk's 3-D view of the stage: an orbit around the middle of the stage.
struct OutsideEye {
    double azimuth_rad = 0.5, elevation_rad = 0.55;  ///< as in OrbitView
    double nearness = 0;  ///< 0: all rigs are in sight; 1: e times nearer

    /// Turns the view. The elevation stays above the floor and below straight down.
    void turn(double azimuth_by_rad, double elevation_by_rad);
    /// Moves the view nearer (positive) or farther, within fixed limits.
    void go_nearer(double by);
    bool operator==(const OutsideEye&) const = default;
};

/// The parts of the desk that the operator has switched on.
struct DeskSwitches {
    bool panels = true;       ///< false: only the picture is shown
    int help = 0;             ///< page of the help that is shown; 0: none
    bool rigs = true;         ///< pictures and state of each rig, in a row at the bottom
    bool rigs_apart = false;  ///< the rigs are in a window of their own instead of the row
    bool figures = false;     ///< the side panel shows the measurements since the start
    bool outside = false;     ///< the stage is shown in 3-D instead of from above
    OutsideEye eye = {};      ///< viewpoint of the 3-D view
    bool operator==(const DeskSwitches&) const = default;
};

/// A window's position and size on the monitors, in the coordinates of the window system.
struct WindowPlace {
    int x = 0, y = 0, width = 1280, height = 720;
    bool is_maximised = false;  ///< position and size are then those of the restored window
    bool operator==(const WindowPlace&) const = default;
};

/// The operator's arrangement of the desk, which a desk file keeps between sessions.
struct DeskArrangement {
    DeskSwitches switches;  ///< `help` is not kept
    std::optional<WindowPlace> window = {};
    std::optional<WindowPlace> rigs_window = {};
    bool operator==(const DeskArrangement&) const = default;
};

/// Reads a desk file (docs/reference/formats.md lists the keys). Throws Error with file and line
/// for an unknown key or a value outside its range.
DeskArrangement load_desk(const std::filesystem::path& path);
/// Formats a desk file that load_desk() reads; angles are rounded to 0.1 degrees.
std::string to_toml(const DeskArrangement& desk);

/// Keeps the desk's arrangement in a file beside the stage's or the take's file. KeptFile decides
/// when the file is written and how an existing one is replaced. Used on the session's thread.
class DeskStore {
  public:
    /// Reads the file if it exists. Throws Error as load_desk() does.
    explicit DeskStore(std::filesystem::path file);

    /// The arrangement that the session starts with.
    const DeskArrangement& desk() const { return desk_; }
    /// Takes the present arrangement and writes the file when it is due. Call it often.
    void follow(const DeskArrangement& desk, MonotonicTime now);
    /// Writes all changes that are not written yet.
    void finish();

  private:
    KeptFile file_;
    DeskArrangement desk_;
};

/// Returns STAGE.desk.toml for STAGE.toml, and TAKE.desk.toml for TAKE.mkv.
std::filesystem::path desk_file_of(std::filesystem::path file);

/// Number of shots that the desk shows, one for each number key.
constexpr int shot_places = 9;

/// A rectangle in the window, in pixels from the upper left corner.
struct DeskRect {
    float left = 0, top = 0, width = 0, height = 0;

    float right() const { return left + width; }
    float bottom() const { return top + height; }
    bool is_empty() const { return width < 1 || height < 1; }
    bool contains(float x, float y) const {
        return x >= left && x < right() && y >= top && y < bottom();
    }
    DeskRect shrunk(float by) const {
        return {left + by, top + by, width - 2 * by, height - 2 * by};
    }
    /// The largest centred rectangle in it with this aspect (height divided by width).
    DeskRect fitted(float aspect) const;
};

/// Returns the font height for a window of this size: a fixed share of the window, but never too
/// small to read. `content_scale` is the display's scale: 2 on a display of twice the usual
/// density.
float letter_height_px(float width_px, float height_px, float content_scale);

/// The rectangles of the desk's parts. A part that a small window has no room for is empty.
struct DeskLayout {
    DeskRect status, programme, preview, shots, clips, side, time_line, rigs;
    int rig_rows = 1;
};

/// Lays out the desk. `em_px` is the font height, `rigs` the number of rigs in the row, `aspect`
/// height divided by width of the programme's picture. With `has_clips` there is a column for
/// clips. With `has_preview` the preview's picture stands beside the programme's, each below its
/// name.
DeskLayout desk_layout(float width_px, float height_px, float em_px, int rigs, float aspect,
                       bool has_clips = false, bool has_preview = false);
/// Returns the number of rows in which the rigs' cells are largest when they fill a whole window.
int best_rig_rows(float width_px, float height_px, float em_px, int rigs);
/// Lays out the pictures alone, without panels.
DeskLayout pictures_alone(float width_px, float height_px, bool has_preview);

}  // namespace vantage
