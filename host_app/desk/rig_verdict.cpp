#include "host_app/desk/rig_verdict.h"

namespace vantage {

RigLook look_of(RigState state) {
    switch (state) {
        case RigState::present:
            return {"live", Mark::good};
        case RigState::starting:
            return {"no picture yet", Mark::care};
        case RigState::late:
            return {"late", Mark::care};
        case RigState::missed:
            return {"missed", Mark::care};
        case RigState::refused:
            return {"refused", Mark::bad};
        case RigState::disconnected:
            break;
    }
    return {"no link", Mark::bad};
}

}  // namespace vantage
