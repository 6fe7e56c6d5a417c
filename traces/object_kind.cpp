#include "traces/object_kind.hpp"

namespace raycache::traces {

const char* name_of(ObjectKind kind) {
    switch (kind) {
        case ObjectKind::node:
            return "node";
        case ObjectKind::triangle:
            return "triangle";
        case ObjectKind::texel:
            return "texel";
        case ObjectKind::ray_state:
            return "ray state";
        case ObjectKind::hit:
            return "hit";
        case ObjectKind::queue:
            return "queue";
        case ObjectKind::ray_state_write:
            return "ray state write";
        case ObjectKind::hit_write:
            return "hit write";
        case ObjectKind::queue_write:
            return "queue write";
        case ObjectKind::sort:
            return "sort";
    }
    return "?";
}

}  // namespace raycache::traces
