// Which channels of an OpenEXR file make a picture, whichever library reads it.
#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace mirrorball::detail {

/// Of all channels those that make a picture, by their plain names or those of the first layer that
/// has one ("left.R"): R G B, R G B A, Y, or Y A.
inline std::optional<std::vector<std::string>> picture_channels(
    const std::vector<std::string>& channels) {
    const auto has = [&](const std::string& name) {
        return std::find(channels.begin(), channels.end(), name) != channels.end();
    };
    std::set<std::string> layers{""};
    for (const std::string& channel : channels) {
        const std::size_t dot = channel.rfind('.');
        if (dot != std::string::npos && dot > 0 && dot + 1 < channel.size())
            layers.insert(channel.substr(0, dot + 1));
    }
    for (const std::string& layer : layers) {
        std::vector<std::string> names;
        if (has(layer + "R") && has(layer + "G") && has(layer + "B"))
            names = {layer + "R", layer + "G", layer + "B"};
        else if (has(layer + "Y") && !has(layer + "RY") && !has(layer + "BY"))
            names = {layer + "Y"};
        else
            continue;
        if (has(layer + "A")) names.push_back(layer + "A");
        return names;
    }
    return std::nullopt;
}

}  // namespace mirrorball::detail
