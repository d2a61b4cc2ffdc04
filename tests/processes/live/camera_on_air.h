#pragma once

#include <gtest/gtest.h>

#include "host_app/control/ports/sockets.h"
#include "host_app/control/tracking/freed_message.h"

namespace vantage {

/// Receives the camera of every tick as FreeD, like a graphics computer.
class CameraOnAir {
  public:
    explicit CameraOnAir(int port)
        : socket_(UdpSocket::bound({"127.0.0.1", port, true}, "the test")) {}

    /// Returns the camera of the next tick.
    Pose next() {
        for (int i = 0; i < 600; ++i)
            if (const auto message = socket_.receive(std::chrono::milliseconds(100)))
                if (const auto camera = decode_freed(message->bytes))
                    return camera->world_from_camera;
        ADD_FAILURE() << "no camera came";
        return Pose::Identity();
    }
    /// Returns the camera of the latest tick that has arrived.
    Pose newest() {
        while (socket_.receive(std::chrono::milliseconds(0)))
            ;
        return next();
    }

  private:
    UdpSocket socket_;
};

inline double way_m(const Pose& a, const Pose& b) {
    return (a.translation() - b.translation()).norm();
}

}  // namespace vantage
