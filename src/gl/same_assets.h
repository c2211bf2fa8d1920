// Which assets of two sets are the same, value by value: what was made of those can stay.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include <mirrorball/mesh.h>
#include <mirrorball/scene_assets.h>

namespace mirrorball::gl {

inline bool is_same(const Mesh& a, const Mesh& b) {
    return a.positions == b.positions && a.normals == b.normals &&
           a.texture_coordinates == b.texture_coordinates && a.tangents == b.tangents &&
           a.indices == b.indices;
}

inline bool is_same(const Image& a, const Image& b) {
    return a.width() == b.width() && a.height() == b.height() && a.channels() == b.channels() &&
           std::equal(a.values().begin(), a.values().end(), b.values().begin());
}

inline bool is_same(const EnvironmentMap& a, const EnvironmentMap& b) {
    if (shape_of(a) != shape_of(b)) return false;
    const auto &x = a.levels[0].faces, &y = b.levels[0].faces;  // of which all maps are made
    return std::equal(x.begin(), x.end(), y.begin(),
                      [](const Image& s, const Image& t) { return is_same(s, t); });
}

/// Those of one set of assets are shared with the next, not made anew.
inline bool is_same(const std::shared_ptr<const BumpTexels>& a,
                    const std::shared_ptr<const BumpTexels>& b) {
    return a == b;
}

/// By name.
template <class Asset>
bool is_same(const std::map<std::string, Asset>& a, const std::map<std::string, Asset>& b,
             const std::string& name) {
    const auto in_a = a.find(name), in_b = b.find(name);
    return in_a != a.end() && in_b != b.end() && is_same(in_a->second, in_b->second);
}

}  // namespace mirrorball::gl
