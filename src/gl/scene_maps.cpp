#include "scene_maps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <mirrorball/reflection_maps.h>
#include <mirrorball/scene_assets.h>

#include "core/part_of.h"
#include "scene/method_lookup.h"

namespace mirrorball::gl {

using detail::part_of;

namespace {

// Maps with rims are cut out of cubes on the graphics card: sphere maps for each camera anew, and
// paraboloids because what goes on beyond their rims is then there to be filtered with.
bool is_warped(Method method) {
    const Projection projection = projection_of(method);
    return projection == Projection::sphere || projection == Projection::dual_paraboloid;
}

// In whose frame sphere maps are looked up, and which the environment's turn is not part of.
bool is_for_camera(Method method) {
    return projection_of(method) == Projection::sphere;
}

// The edge (of an equirect the width) of a map that is as fine as a cube whose faces have `size`.
int size_as_fine(const EnvironmentMap& environment, Projection projection, int size) {
    const double finer = static_cast<double>(mirror_map_size(environment, projection)) /
                         mirror_map_size(environment, Projection::cube);
    return static_cast<int>(std::lround(finer * size));
}

constexpr std::uint64_t kMostUnusedBytes = 64 << 20;

// Of the progress, about.
constexpr double kMirrorShare = 0.3, kDiffuseEnd = 0.5;

Texture uploaded(const EnvironmentMap& map, Method method) {
    return method == Method::cube_seams ? upload_face_array(map) : upload(map);
}

}  // namespace

SceneMaps::SceneMaps(std::shared_ptr<LobeFilter> filter, Method method, int size, bool rough,
                     std::shared_ptr<const BakedMaps> baked, const Progress& progress)
    : filter_(std::move(filter)),
      baked_(std::move(baked)),
      method_(method),
      projection_(is_warped(method) ? Projection::cube : projection_of(method)),
      size_(size),
      axes_(default_axes(projection_)) {
    const EnvironmentMap& environment = filter_->source();
    const int map_size = size_as_fine(environment, projection_, size);
    // Before it takes time and memory.
    check_texture_size(target_for(projection_), map_size, 1);
    const EnvironmentMap mirror = make_mirror_map(environment, projection_, map_size, axes_,
                                                  part_of(progress, 0, kMirrorShare));
    maps_.mirror = uploaded(mirror, method);
    if (method == Method::cube_split) maps_.mirror_faces = upload_faces(mirror);
    // A roughness for each pixel takes a lookup for each.
    const bool gets_rough = rough && detail::looks_up_per_pixel(method);
    const double diffuse_end = gets_rough ? kDiffuseEnd : 1;
    maps_.diffuse = uploaded(
        filtered(diffuse_target(projection_, axes_), part_of(progress, kMirrorShare, diffuse_end)),
        method);
    if (gets_rough) make_rough(part_of(progress, diffuse_end, 1));
    if (is_warped(method)) warped_.emplace(method, maps_);
}

EnvironmentMap SceneMaps::filtered(const PrefilterTarget& target, const Progress& progress) const {
    return baked_ ? (*baked_)(target) : (*filter_)(target, progress);
}

void SceneMaps::make_rough(const Progress& progress) {
    std::vector<EnvironmentMap> levels;
    const std::vector<PrefilterTarget> targets =
        rough_targets(filter_->source(), projection_, axes_);
    const auto count = static_cast<double>(targets.size());
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const auto begun = static_cast<double>(i);
        levels.push_back(
            filtered(targets[i], part_of(progress, begun / count, (begun + 1) / count)));
    }
    maps_.rough = uploaded(levels_of(levels), method_);
}

void SceneMaps::make_glossy(const Lobe& lobe, bool quick, const Progress& progress) {
    const PrefilterTarget fine = glossy_target(filter_->source(), lobe, projection_, axes_);
    // What is baked is there already.
    const PrefilterTarget target = quick && !baked_ ? quicker(fine) : fine;
    const EnvironmentMap map = filtered(target, progress);
    Texture texture = uploaded(map, method_);
    if (method_ == Method::cube_split) maps_.glossy_faces.push_back(upload_faces(map));
    maps_.glossy.push_back(std::move(texture));
    lobes_.push_back({lobe, target.size < fine.size, 0});
    if (warped_) warped_->add_glossy(maps_.glossy.back());
}

// And could be looked up in maps of every roughness.
bool SceneMaps::takes_long(const Lobe& lobe) const {
    return lobe.kind == Lobe::Kind::ggx && detail::looks_up_per_pixel(method_) && !baked_ &&
           !filter_->is_quick(glossy_target(filter_->source(), lobe, projection_, axes_));
}

void SceneMaps::set_lobes(std::span<const Lobe> lobes, bool quick, const Progress& progress) {
    ++turn_;
    double begun = 0;
    const auto count = static_cast<double>(lobes.size());
    for (const Lobe& lobe : lobes) {
        std::size_t i = index_of(lobe);
        if (!quick && i < lobes_.size() && lobes_[i].is_coarse) {
            forget(i);
            i = lobes_.size();
        }
        const Progress of_lobe = part_of(progress, begun / count, (begun + 1) / count);
        ++begun;
        if (i == lobes_.size()) {
            if (quick && takes_long(lobe)) {
                need_rough(of_lobe);
                continue;
            }
            make_glossy(lobe, quick, of_lobe);
        }
        lobes_[i].used = turn_;
    }
    forget_unused();
}

void SceneMaps::need_rough(const Progress& progress) {
    if (!maps_.rough.empty()) return;
    make_rough(progress);
    if (!warped_) return;
    warped_.emplace(method_, maps_);
    made_for_.reset();
}

// The least recently used first. All of those that are warped: they would be for each camera.
void SceneMaps::forget_unused() {
    const std::uint64_t most = warped_ ? 0 : kMostUnusedBytes;
    while (unused_bytes() > most) {
        const auto oldest =
            std::min_element(lobes_.begin(), lobes_.end(),
                             [](const Kept& a, const Kept& b) { return a.used < b.used; });
        forget(static_cast<std::size_t>(oldest - lobes_.begin()));
    }
}

void SceneMaps::forget(std::size_t lobe) {
    const auto place = static_cast<std::ptrdiff_t>(lobe);
    lobes_.erase(lobes_.begin() + place);
    maps_.glossy.erase(maps_.glossy.begin() + place);
    if (!maps_.glossy_faces.empty()) maps_.glossy_faces.erase(maps_.glossy_faces.begin() + place);
    if (warped_) warped_->remove_glossy(lobe);
}

std::uint64_t SceneMaps::unused_bytes() const {
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < lobes_.size(); ++i)
        bytes += lobes_[i].used < turn_ ? maps_.glossy[i].bytes() : 0;
    return bytes;
}

// Behind the last if it is not there.
std::size_t SceneMaps::index_of(const Lobe& lobe) const {
    const auto found = std::find_if(lobes_.begin(), lobes_.end(),
                                    [&](const Kept& kept) { return kept.lobe == lobe; });
    return static_cast<std::size_t>(found - lobes_.begin());
}

void SceneMaps::look_from(const Axes& camera, const SceneEnvironment& environment) {
    if (!warped_) return;
    const std::pair made_for = is_for_camera(method_)
                                   ? std::pair(turned(axes_, environment), camera)
                                   : std::pair(axes_, Axes());
    if (made_for_ == made_for) return;
    warped_->make(maps_, made_for.first, made_for.second);
    made_for_ = made_for;
}

LookupMaps SceneMaps::lookup(const Material& material, const SceneEnvironment& environment) const {
    const Axes& axes = warped_ ? warped_->axes() : axes_;
    const std::size_t lobe = index_of(material.lobe);
    return {method_,
            is_for_camera(method_) ? axes : turned(axes, environment),
            &shown(),
            &shown().diffuse,
            lobe,
            material.glossy > 0 && lobe == lobes_.size(),
            mirror_alpha(size_),
            environment.intensity,
            environment.proxy,
            environment.captured_at};
}

}  // namespace mirrorball::gl
