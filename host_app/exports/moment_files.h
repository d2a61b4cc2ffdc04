#pragma once

#include <filesystem>
#include <vector>

#include "host_app/exports/moment.h"

namespace vantage {

// Exports of one moment in the formats of other programs. Files are written atomically; a `folder`
// is created. All throw Error if a file cannot be written.

/// Coloured points in Stanford's polygon format (PLY), binary, in metres in the stage's world frame
/// (y up): points only...
void write_ply(const std::vector<SurfacePoint>& points, const std::filesystem::path& file);
/// ...and points with surfaces.
void write_ply(const Moment& moment, const std::filesystem::path& file);
/// glTF 2.0 in one file: an unlit primitive of triangles in the stage's world frame.
void write_glb(const Moment& moment, const std::filesystem::path& file);

/// For training radiance fields and Gaussian splats: images/, depth/ (16-bit PNG, millimetres,
/// 0 = unknown), transforms.json (OpenGL's axes) and sparse/0, a COLMAP model as text. In both, the
/// corner of the image is at (0, 0), half a pixel before the centre of the first pixel.
void write_training_folder(const Moment& moment, const std::filesystem::path& folder);
/// A view set for `vantage render --views`.
void write_view_set(const Moment& moment, const std::filesystem::path& folder);

/// One OpenEXR file per rig, for compositors: R, G and B as linear light
/// (Rec. 709 primaries, half floats), Z in metres along the camera's axis (floats, 0: unknown), the
/// attribute worldToCamera, and the intrinsics K in px.
void write_exr_folder(const Moment& moment, const std::filesystem::path& folder);

/// An MPEG view set of one frame for TMIV and RVS: sequence.json with the
/// cameras (OMAF's axes), and per rig NAME_texture_WxH_yuv420p10le.yuv and
/// NAME_depth_WxH_yuv420p16le.yuv. Depth is inverse, 1 (farthest) to 65535 (nearest) over the range
/// in sequence.json, 0 if unknown. An odd last row or column is cut off. Throws Error if no rig has
/// depth.
void write_mpeg_views(const Moment& moment, const std::filesystem::path& folder);

}  // namespace vantage
