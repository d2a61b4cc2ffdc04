#pragma once

#include <array>
#include <string>

#include "common/image/image.h"

namespace vantage {

/// Generated films of kinds that real rigs meet and the virtual stage has not: plain surfaces in
/// front of plain backgrounds, light that moves, exposure that drifts. A wall, a floor and a few
/// flat things that face the cameras, so that every camera on the rigs' line sees an exact picture.
enum class FilmScene {
    box,     ///< a plain brown box on a blue belt, and a hand
    brown,   ///< a brown box in front of a brown belt
    white,   ///< white in front of white
    leaves,  ///< hard shadows of leaves that move over wall and floor
    drift    ///< exposure and white balance drift
};
inline constexpr std::array all_film_scenes{FilmScene::box, FilmScene::brown, FilmScene::white,
                                            FilmScene::leaves, FilmScene::drift};

const char* words_of(FilmScene scene);
/// Throws Error for a name that is none, with those there are.
FilmScene parse_film_scene(const std::string& text);

/// What a camera sees, without noise.
struct SceneFrame {
    ColourImage colour;
    cv::Mat1b performers;  ///< 255 where a thing that moves is in front
    cv::Mat1b moving;      ///< those, and where moving light changes the background
};

/// The geometry of the films: cameras side by side on one line, a baseline between two of them.
struct SceneCamera {
    double f_px = 0, baseline_m = 0;
};
SceneCamera scene_camera(cv::Size size);

/// Renders a scene from `baselines` to the right of the first rig's left camera.
SceneFrame film_scene(FilmScene scene, double time_s, double baselines, cv::Size size);

}  // namespace vantage
