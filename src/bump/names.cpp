#include <mirrorball/bump.h>

#include "core/name_table.h"

namespace mirrorball {
namespace {

constexpr detail::NameTable<Wrap, 3> kWraps{"a way to wrap", {"repeat", "clamp", "mirror"}};
constexpr detail::NameTable<Green, 2> kGreens{"a way for green to point", {"up", "down"}};
constexpr detail::NameTable<BumpKind, 3> kKinds{"a kind of bump map", {"height", "normal", "dudv"}};

}  // namespace

std::string_view name(Wrap wrap) {
    return kWraps.name(wrap);
}

Wrap parse_wrap(std::string_view name) {
    return kWraps.parse(name);
}

std::string_view name(Green green) {
    return kGreens.name(green);
}

Green parse_green(std::string_view name) {
    return kGreens.parse(name);
}

std::string_view name(BumpKind kind) {
    return kKinds.name(kind);
}

BumpKind parse_bump_kind(std::string_view name) {
    return kKinds.parse(name);
}

}  // namespace mirrorball
