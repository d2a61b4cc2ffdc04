#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/log.h"
#include "host_app/camera_paths/camera_path.h"

extern "C" {
#include <libavutil/base64.h>
}

namespace vantage {
namespace {

using Json = nlohmann::json;

constexpr std::size_t most_bytes = 1 << 28;
constexpr std::string_view data_uri = "data:application/octet-stream;base64,";
constexpr int of_float = 5126;
constexpr std::uint32_t glb_version = 2;

/// A camera of glTF looks along its -z, with y up; the world's axes are the stage's.
Eigen::Matrix3d gltf_from_opencv() { return Eigen::Vector3d(1, -1, -1).asDiagonal(); }

/// Numbers of `width` along time.
struct Channel {
    std::vector<double> times_s;
    std::vector<Eigen::Vector4d> values;
    bool steps = false;

    Eigen::Vector4d at(double time_s, bool is_rotation) const {
        const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
        if (after == times_s.begin()) return values.front();
        if (after == times_s.end()) return values.back();
        const auto i = static_cast<std::size_t>(after - times_s.begin()) - 1;
        if (steps) return values[i];
        const double share = (time_s - times_s[i]) / (times_s[i + 1] - times_s[i]);
        if (!is_rotation) return values[i] + share * (values[i + 1] - values[i]);
        return Eigen::Quaterniond(values[i])
            .slerp(share, Eigen::Quaterniond(values[i + 1]))
            .coeffs();
    }
};

class GltfFile {
  public:
    GltfFile(std::span<const std::byte> bytes, std::filesystem::path file)
        : file_(std::move(file)) {
        constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
        if (bytes.size() < header_bytes || std::memcmp(bytes.data(), "glTF", 4) != 0) {
            json_ = Json::parse(reinterpret_cast<const char*>(bytes.data()),
                                reinterpret_cast<const char*>(bytes.data()) + bytes.size());
            return;
        }
        for (std::size_t at = header_bytes; at + chunk_header_bytes <= bytes.size();) {
            std::uint32_t size = 0;
            std::memcpy(&size, &bytes[at], sizeof size);
            const auto chunk = bytes.subspan(at + chunk_header_bytes);
            if (size > chunk.size()) fail("{} is cut off", file_.string());
            const auto* text = reinterpret_cast<const char*>(chunk.data());
            if (std::memcmp(&bytes[at + 4], "JSON", 4) == 0)
                json_ = Json::parse(text, text + size);
            else if (std::memcmp(&bytes[at + 4], "BIN", 4) == 0)
                binary_.assign(text, size);
            at += chunk_header_bytes + size;
        }
    }

    const Json& json() const { return json_; }

    /// The elements of an accessor of floats, `width` numbers each; quaternions as x, y, z, w.
    std::vector<Eigen::Vector4d> elements(const Json& number, int width) {
        const Json& accessor = json_.at("accessors").at(number.get<std::size_t>());
        static constexpr std::array types{"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        if (accessor.at("componentType").get<int>() != of_float || accessor.contains("sparse") ||
            accessor.at("type").get<std::string>() != types[static_cast<std::size_t>(width)])
            fail("{}: an animation's numbers are not plain floats of the type {}", file_.string(),
                 types[static_cast<std::size_t>(width)]);
        const Json& view = json_.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
        const std::string& buffer = buffer_of(view.at("buffer").get<std::size_t>());
        const auto count = accessor.at("count").get<std::size_t>();
        const std::size_t element = static_cast<std::size_t>(width) * sizeof(float);
        const std::size_t stride = view.value("byteStride", element);
        const std::size_t begin =
            view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
        if (count == 0 || count > most_bytes / element || stride > most_bytes / count ||
            begin > buffer.size() || stride * (count - 1) + element > buffer.size() - begin)
            fail("{}: an animation's numbers are outside their buffer", file_.string());
        std::vector<Eigen::Vector4d> values(count, Eigen::Vector4d::Zero());
        for (std::size_t i = 0; i < count; ++i)
            for (int c = 0; c < width; ++c) {
                float value = 0;
                std::memcpy(
                    &value,
                    buffer.data() + begin + i * stride + static_cast<std::size_t>(c) * sizeof value,
                    sizeof value);
                if (!std::isfinite(value))
                    fail("{}: a number of an animation is not finite", file_.string());
                values[i][c] = value;
            }
        return values;
    }

  private:
    const std::string& buffer_of(std::size_t number) {
        const Json& buffer = json_.at("buffers").at(number);
        if (!buffer.contains("uri")) return binary_;
        std::string& bytes = buffers_[number];
        if (!bytes.empty()) return bytes;
        const auto uri = buffer.at("uri").get<std::string>();
        if (uri.starts_with("data:")) {
            const std::size_t comma = uri.find(";base64,");
            if (comma == std::string::npos) fail("{}: a buffer is not base64", file_.string());
            const std::string code = uri.substr(comma + 8);
            bytes.resize(AV_BASE64_DECODE_SIZE(code.size()));
            const int size = av_base64_decode(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                              code.c_str(), static_cast<int>(bytes.size()));
            if (size < 0) fail("{}: a buffer is not base64", file_.string());
            bytes.resize(static_cast<std::size_t>(size));
            return bytes;
        }
        const std::filesystem::path name(uri);
        if (name != name.filename())
            fail("{}: its buffer '{}' is not beside it", file_.string(), uri);
        const std::vector<std::byte> read = read_file(file_.parent_path() / name, most_bytes);
        bytes.assign(reinterpret_cast<const char*>(read.data()), read.size());
        return bytes;
    }

    std::filesystem::path file_;
    Json json_;
    std::string binary_;
    std::map<std::size_t, std::string> buffers_;
};

/// The camera's way through a file's animations.
class GltfCamera {
  public:
    GltfCamera(GltfFile& gltf, const std::filesystem::path& file)
        : json_(gltf.json()), file_(file) {
        const Json& nodes = json_.at("nodes");
        std::string others;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (const Json& child : nodes[i].value("children", Json::array()))
                parents_[child.get<std::size_t>()] = i;
            if (!nodes[i].contains("camera")) continue;
            const auto camera = nodes[i].at("camera").get<std::size_t>();
            if (node_ || !json_.at("cameras").at(camera).contains("perspective")) {
                others += (others.empty() ? "" : ", ") + name_of(nodes[i], "node", i);
                continue;
            }
            node_ = i;
            camera_ = camera;
        }
        if (!node_) fail("{} has no perspective camera", file.string());
        if (!others.empty())
            log_warning("{} has several cameras: {} is taken and {} is left out", file.string(),
                        name_of(nodes[*node_], "node", *node_), others);
        take_animations(gltf);
    }

    double end_s() const { return end_s_; }

    Pose at(double time_s) const {
        Eigen::Affine3d world_from_node = Eigen::Affine3d::Identity();
        std::size_t node = *node_;
        // No longer than there are nodes, whatever a file says.
        for (std::size_t i = 0; i < json_.at("nodes").size(); ++i) {
            world_from_node = transform_of(node, time_s) * world_from_node;
            const auto parent = parents_.find(node);
            if (parent == parents_.end()) break;
            node = parent->second;
        }
        // A scale above the camera moves its eye; the camera itself is never scaled.
        Pose pose = Pose::Identity();
        pose.translation() = world_from_node.translation();
        pose.linear() = rotation_of(world_from_node.linear()) * gltf_from_opencv();
        return pose;
    }
    double field_of_view_rad(double time_s, double usual_aspect) const {
        const Json& lens = json_.at("cameras").at(camera_).at("perspective");
        const double up_rad = lens_ ? lens_->at(time_s, false)[0] : lens.at("yfov").get<double>();
        return 2 * std::atan(std::tan(0.5 * up_rad) * lens.value("aspectRatio", usual_aspect));
    }

  private:
    /// The rotation nearest to a matrix that may scale and shear. Throws Error for a mirror.
    Eigen::Matrix3d rotation_of(const Eigen::Matrix3d& matrix) const {
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix,
                                                    Eigen::ComputeFullU | Eigen::ComputeFullV);
        if (!(svd.singularValues()[2] > 0) || !(matrix.determinant() > 0))
            fail("{}: a node above the camera mirrors it or flattens it; apply its scale",
                 file_.string());
        return svd.matrixU() * svd.matrixV().transpose();
    }

    static std::string name_of(const Json& thing, const char* kind, std::size_t number) {
        const std::string name = thing.value("name", "");
        return name.empty() ? fmt::format("{} {}", kind, number) : fmt::format("'{}'", name);
    }

    /// The target of a channel, such as "translation 3"; empty if it does not move the camera.
    std::string moved_by(const Json& channel) const {
        const Json& target = channel.at("target");
        const auto path = target.at("path").get<std::string>();
        if (path == "pointer")
            return target.at("extensions")
                               .at("KHR_animation_pointer")
                               .at("pointer")
                               .get<std::string>() ==
                           fmt::format("/cameras/{}/perspective/yfov", camera_)
                       ? "lens"
                       : "";
        if (path != "rotation" && path != "translation" && path != "scale") return "";
        const auto node = target.at("node").get<std::size_t>();
        return moves_camera(node) ? fmt::format("{} {}", path, node) : "";
    }

    /// The camera's node and those above it.
    bool moves_camera(std::size_t wanted) const {
        std::size_t node = *node_;
        for (std::size_t i = 0; i < json_.at("nodes").size(); ++i) {
            if (node == wanted) return true;
            const auto parent = parents_.find(node);
            if (parent == parents_.end()) return false;
            node = parent->second;
        }
        return false;
    }

    /// Programs write one animation for each object, or one for each take. Animations that move
    /// different things belong together; one that moves again what is moved already is another
    /// take.
    void take_animations(GltfFile& gltf) {
        std::set<std::string> moved;
        std::string taken, left_out;
        const Json animations = json_.value("animations", Json::array());
        for (std::size_t i = 0; i < animations.size(); ++i) {
            const std::string name = name_of(animations[i], "animation", i);
            std::set<std::string> own;
            bool is_other_take = false;
            for (const Json& channel : animations[i].at("channels")) {
                const std::string what = moved_by(channel);
                if (what.empty()) continue;
                is_other_take = is_other_take || moved.contains(what);
                own.insert(what);
            }
            if (own.empty()) continue;
            std::string& list = is_other_take ? left_out : taken;
            list += (list.empty() ? "" : ", ") + name;
            if (is_other_take) continue;
            moved.merge(own);
            for (const Json& channel : animations[i].at("channels"))
                if (!moved_by(channel).empty()) take(gltf, animations[i], channel, file_);
        }
        if (!left_out.empty())
            log_warning(
                "{} has several takes of the camera: {} is taken and {} is left out; export the "
                "wanted one alone for another",
                file_.string(), taken, left_out);
    }

    void take(GltfFile& gltf, const Json& animation, const Json& channel,
              const std::filesystem::path& file) {
        const Json& target = channel.at("target");
        const auto path = target.at("path").get<std::string>();
        const bool is_lens =
            path == "pointer" &&
            target.at("extensions").at("KHR_animation_pointer").at("pointer").get<std::string>() ==
                fmt::format("/cameras/{}/perspective/yfov", camera_);
        const bool is_turn = path == "rotation";
        const Json& sampler = animation.at("samplers").at(channel.at("sampler").get<std::size_t>());
        const std::string kind = sampler.value("interpolation", "LINEAR");
        if (kind != "LINEAR" && kind != "STEP")
            fail("{}: an animation is {}; bake it to LINEAR", file.string(), kind);
        Channel taken;
        taken.steps = kind == "STEP";
        for (const Eigen::Vector4d& time : gltf.elements(sampler.at("input"), 1))
            taken.times_s.push_back(time[0]);
        taken.values = gltf.elements(sampler.at("output"), is_lens ? 1 : is_turn ? 4 : 3);
        if (taken.values.size() != taken.times_s.size() ||
            !std::is_sorted(taken.times_s.begin(), taken.times_s.end(), std::less_equal<>()))
            fail("{}: the times of an animation do not grow, or do not go with its values",
                 file.string());
        if (is_turn)
            for (Eigen::Vector4d& q : taken.values) {
                if (!(q.norm() > 0.5)) fail("{}: a rotation is no quaternion", file.string());
                q.normalize();
            }
        end_s_ = std::max(end_s_, taken.times_s.back());
        if (is_lens)
            lens_ = std::move(taken);
        else
            (is_turn           ? turns_
             : path == "scale" ? scales_
                               : ways_)[target.at("node").get<std::size_t>()] = std::move(taken);
    }

    Eigen::Affine3d transform_of(std::size_t number, double time_s) const {
        const Json& node = json_.at("nodes").at(number);
        Eigen::Affine3d transform = Eigen::Affine3d::Identity();
        if (node.contains("matrix")) {
            for (std::size_t i = 0; i < 16; ++i)
                transform.matrix().data()[i] = node.at("matrix").at(i).get<double>();
            return transform;
        }
        const auto value = [&](const char* key, const std::map<std::size_t, Channel>& channels,
                               Eigen::Vector4d usual, std::size_t width) {
            if (const auto channel = channels.find(number); channel != channels.end())
                return channel->second.at(time_s, width == 4);
            if (node.contains(key))
                for (std::size_t i = 0; i < width; ++i)
                    usual[static_cast<Eigen::Index>(i)] = node.at(key).at(i).get<double>();
            return usual;
        };
        const Eigen::Vector4d turn = value("rotation", turns_, Eigen::Vector4d::UnitW(), 4);
        transform.translate(
            Eigen::Vector3d(value("translation", ways_, Eigen::Vector4d::Zero(), 3).head<3>()));
        transform.rotate(Eigen::Quaterniond(turn).normalized());
        // A camera's own scale moves nothing but what is below it.
        if (number != *node_)
            transform.scale(
                Eigen::Vector3d(value("scale", scales_, Eigen::Vector4d::Ones(), 3).head<3>()));
        return transform;
    }

    const Json& json_;
    std::filesystem::path file_;
    std::optional<std::size_t> node_;
    std::size_t camera_ = 0;
    std::map<std::size_t, std::size_t> parents_;
    std::map<std::size_t, Channel> ways_, turns_, scales_;  ///< by node
    std::optional<Channel> lens_;
    double end_s_ = 0;
};

void append(std::string& bytes, const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string base64(const std::string& bytes) {
    std::string code(AV_BASE64_SIZE(bytes.size()), '\0');
    if (!av_base64_encode(code.data(), static_cast<int>(code.size()),
                          reinterpret_cast<const std::uint8_t*>(bytes.data()),
                          static_cast<int>(bytes.size())))
        fail("an animation of {} bytes is too long for a glTF file", bytes.size());
    code.resize(std::strlen(code.c_str()));
    return code;
}

std::string glb_of(std::string text, std::string binary) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
    std::string bytes = "glTF";
    append(bytes, glb_version);
    append(bytes, static_cast<std::uint32_t>(header_bytes + 2 * chunk_header_bytes + text.size() +
                                             binary.size()));
    append(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += "JSON" + text;
    append(bytes, static_cast<std::uint32_t>(binary.size()));
    return bytes + std::string("BIN\0", 4) + binary;
}

void write(const CameraPath& path, const std::filesystem::path& file) {
    const double aspect = static_cast<double>(path.size_px.width) / path.size_px.height;
    const auto up_rad = [&](const CameraState& camera) {
        return 2 * std::atan(std::tan(0.5 * camera.field_of_view_rad) / aspect);
    };
    std::string times, ways, turns, lenses;
    for (std::size_t i = 0; i < path.cameras.size(); ++i) {
        const CameraState& camera = path.cameras[i];
        append(times, static_cast<float>(static_cast<double>(i) / path.rate_hz));
        const Eigen::Vector3f way = camera.world_from_camera.translation().cast<float>();
        const Eigen::Quaternionf turn(
            Eigen::Matrix3d(camera.world_from_camera.linear() * gltf_from_opencv()).cast<float>());
        for (int c = 0; c < 3; ++c) append(ways, way[c]);
        for (int c = 0; c < 4; ++c) append(turns, turn.coeffs()[c]);
        append(lenses, static_cast<float>(up_rad(camera)));
    }
    const std::size_t count = path.cameras.size();
    nlohmann::ordered_json views = nlohmann::ordered_json::array();
    std::string binary;
    for (const std::string* part : {&times, &ways, &turns, &lenses}) {
        views.push_back(
            {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", part->size()}});
        binary += *part;
    }
    const auto accessor = [&](int view, const char* type) {
        return nlohmann::ordered_json{
            {"bufferView", view}, {"componentType", of_float}, {"count", count}, {"type", type}};
    };
    nlohmann::ordered_json input = accessor(0, "SCALAR");
    input["min"] = {0.0};
    input["max"] = {static_cast<float>(static_cast<double>(count - 1) / path.rate_hz)};
    const auto sampler = [](int output) {
        return nlohmann::ordered_json{
            {"input", 0}, {"interpolation", "LINEAR"}, {"output", output}};
    };
    const bool is_glb = file.extension() == ".glb";
    nlohmann::ordered_json buffer{{"byteLength", binary.size()}};
    if (!is_glb) buffer["uri"] = std::string(data_uri) + base64(binary);
    const nlohmann::ordered_json json{
        {"asset", {{"version", "2.0"}, {"generator", "vantage"}}},
        {"extensionsUsed", {"KHR_animation_pointer"}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"name", "camera"}, {"camera", 0}}}},
        {"cameras",
         {{{"type", "perspective"},
           {"perspective",
            {{"aspectRatio", aspect}, {"yfov", up_rad(path.cameras.front())}, {"znear", 0.01}}}}}},
        {"animations",
         {{{"name", "flight"},
           {"channels",
            {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
             {{"sampler", 1}, {"target", {{"node", 0}, {"path", "rotation"}}}},
             {{"sampler", 2},
              {"target",
               {{"path", "pointer"},
                {"extensions",
                 {{"KHR_animation_pointer", {{"pointer", "/cameras/0/perspective/yfov"}}}}}}}}}},
           {"samplers", {sampler(1), sampler(2), sampler(3)}}}}},
        {"accessors", {input, accessor(1, "VEC3"), accessor(2, "VEC4"), accessor(3, "SCALAR")}},
        {"bufferViews", views},
        {"buffers", nlohmann::ordered_json::array({buffer})}};
    const std::string bytes = is_glb ? glb_of(json.dump(), binary) : json.dump(1) + '\n';
    write_text_atomically(file, bytes);
}

}  // namespace

CameraPath gltf_path_of(std::span<const std::byte> bytes, const std::filesystem::path& file,
                        const CameraPathSettings& settings) {
    CameraPath path{settings.rate_hz.value_or(default_camera_rate_hz), settings.size_px, {}};
    try {
        GltfFile gltf(bytes, file);
        const GltfCamera camera(gltf, file);
        const double aspect = static_cast<double>(settings.size_px.width) / settings.size_px.height;
        constexpr double rounding = 1e-4;  // of a float's times
        const double count = std::floor(camera.end_s() * path.rate_hz + rounding) + 1;
        require_cameras(static_cast<std::size_t>(std::clamp(count, 0.0, 1e9)), file);
        for (int i = 0; i < static_cast<int>(count); ++i) {
            const double time_s = i / path.rate_hz;
            CameraState state{camera.at(time_s),
                              checked_field_of_view(settings.field_of_view_rad.value_or(
                                                        camera.field_of_view_rad(time_s, aspect)),
                                                    file),
                              settings.focus_m};
            if (!state.world_from_camera.matrix().allFinite())
                fail("{}: the camera has no place", file.string());
            path.cameras.push_back(state);
        }
    } catch (const Json::exception& error) {
        fail("{} is no glTF file with a camera that Vantage reads: {}", file.string(),
             error.what());
    }
    return path;
}

CameraPathForm gltf_form() {
    return {"gltf", "NAME.gltf or NAME.glb, a camera and its animation",
            [](const std::filesystem::path& file) {
                return file.extension() == ".gltf" || file.extension() == ".glb";
            },
            [](const std::filesystem::path& file, const CameraPathSettings& settings) {
                return gltf_path_of(read_file(file, most_bytes), file, settings);
            },
            write};
}

}  // namespace vantage
