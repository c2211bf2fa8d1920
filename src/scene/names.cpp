#include <mirrorball/scene.h>

#include "core/name_table.h"

namespace mirrorball {
namespace {

constexpr detail::NameTable<Coupling, 3> kCouplings{"a coupling",
                                                    {"added", "layered", "split-sum"}};
constexpr detail::NameTable<FaceDrawing, 3> kFaceDrawings{"a way to draw the faces of a cube map",
                                                          {"texture", "copy", "one-pass"}};
constexpr detail::NameTable<BumpForm, 2> kBumpForms{"a form of bump mapping",
                                                    {"normals", "classic"}};
constexpr detail::NameTable<BumpFilter, 3> kBumpFilters{"a filter of bumps",
                                                        {"none", "mean", "variance"}};

}  // namespace

std::string_view name(Coupling coupling) {
    return kCouplings.name(coupling);
}

Coupling parse_coupling(std::string_view name) {
    return kCouplings.parse(name);
}

std::string_view name(FaceDrawing drawing) {
    return kFaceDrawings.name(drawing);
}

FaceDrawing parse_face_drawing(std::string_view name) {
    return kFaceDrawings.parse(name);
}

std::string_view name(BumpForm form) {
    return kBumpForms.name(form);
}

BumpForm parse_bump_form(std::string_view name) {
    return kBumpForms.parse(name);
}

std::string_view name(BumpFilter filter) {
    return kBumpFilters.name(filter);
}

BumpFilter parse_bump_filter(std::string_view name) {
    return kBumpFilters.parse(name);
}

}  // namespace mirrorball
