#include "common/board/marker_dictionary.h"

#include <string>

#include <opencv2/core/version.hpp>

#include "common/base/error.h"

#define VANTAGE_OLD_ARUCO (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 7)
#if VANTAGE_OLD_ARUCO
#include <opencv2/aruco.hpp>
#else
#include <opencv2/objdetect/aruco_detector.hpp>
#endif

namespace vantage {
namespace {

struct NamedDictionary {
    std::string_view name;
    int number;
};

constexpr NamedDictionary dictionaries[] = {
    {"4X4_50", cv::aruco::DICT_4X4_50},
    {"4X4_100", cv::aruco::DICT_4X4_100},
    {"4X4_250", cv::aruco::DICT_4X4_250},
    {"4X4_1000", cv::aruco::DICT_4X4_1000},
    {"5X5_50", cv::aruco::DICT_5X5_50},
    {"5X5_100", cv::aruco::DICT_5X5_100},
    {"5X5_250", cv::aruco::DICT_5X5_250},
    {"5X5_1000", cv::aruco::DICT_5X5_1000},
    {"6X6_250", cv::aruco::DICT_6X6_250},
    {"6X6_1000", cv::aruco::DICT_6X6_1000},
    {"APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11},
};

cv::aruco::Dictionary dictionary(int number) {
#if VANTAGE_OLD_ARUCO
    return *cv::aruco::getPredefinedDictionary(number);
#else
    return cv::aruco::getPredefinedDictionary(number);
#endif
}

}  // namespace

MarkerDictionary::MarkerDictionary(std::string_view name) {
    std::string names;
    for (const NamedDictionary& entry : dictionaries) {
        if (entry.name == name) {
            number_ = entry.number;
            return;
        }
        names += (names.empty() ? "" : ", ") + std::string(entry.name);
    }
    fail("there is no marker dictionary '{}'; there are {}", name, names);
}

int MarkerDictionary::marker_count() const { return dictionary(number_).bytesList.rows; }

cv::Mat1b MarkerDictionary::bits(int id) const {
    const cv::aruco::Dictionary d = dictionary(number_);
    const cv::Mat inner =
        cv::aruco::Dictionary::getBitsFromByteList(d.bytesList.rowRange(id, id + 1), d.markerSize);
    cv::Mat1b bits;
    cv::copyMakeBorder(inner, bits, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    return bits;
}

std::vector<FoundMarker> MarkerDictionary::find(const GreyImage& picture) const {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
#if VANTAGE_OLD_ARUCO
    cv::aruco::detectMarkers(picture, cv::aruco::getPredefinedDictionary(number_), corners, ids);
#else
    cv::aruco::ArucoDetector(dictionary(number_)).detectMarkers(picture, corners, ids);
#endif
    std::vector<FoundMarker> found;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        FoundMarker marker;
        marker.id = ids[i];
        for (std::size_t k = 0; k < 4; ++k) marker.corners[k] = corners[i][k];
        found.push_back(marker);
    }
    return found;
}

}  // namespace vantage
