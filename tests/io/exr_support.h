// OpenEXR files that its own library writes, with what we never write ourselves.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledInputFile.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>

#include "container_support.h"

namespace mirrorball {

using Imath::Box2i;
using Imath::V2i;

/// A picture that the library writes itself, so that it has what we never write.
using ExrChange = std::function<void(Imf::Header&)>;
inline Bytes made(const Image& image, const std::vector<std::string>& channels,
                  const ExrChange& change = {}) {
    const TemporaryFolder folder;
    const std::string path = folder / "made.exr";
    {
        Imf::Header header(image.width(), image.height());
        for (const std::string& name : channels)
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        if (change) change(header);
        const Box2i window = header.dataWindow();
        Imf::FrameBuffer buffer;
        const std::size_t texel = sizeof(float) * image.channels();
        for (std::size_t c = 0; c < channels.size(); ++c)
            buffer.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, image.values().data() + c,
                                                        window.min, image.width(), image.height(),
                                                        texel, texel * image.width()));
        if (header.hasTileDescription()) {
            Imf::TiledOutputFile file(path.c_str(), header, 0);
            file.setFrameBuffer(buffer);
            for (int ly = 0; ly < file.numYLevels(); ++ly)
                for (int lx = 0; lx < file.numXLevels(); ++lx)
                    if (file.isValidLevel(lx, ly))
                        file.writeTiles(0, file.numXTiles(lx) - 1, 0, file.numYTiles(ly) - 1, lx,
                                        ly);
        } else {
            Imf::OutputFile file(path.c_str(), header, 0);
            file.setFrameBuffer(buffer);
            file.writePixels(image.height());
        }
    }
    return file_bytes(path);
}

inline FileContents plain(Image image) {
    FileContents contents;
    contents.levels.emplace_back().push_back(std::move(image));
    return contents;
}

/// A part of a file that has several.
struct MadePart {
    Image image;
    std::vector<std::string> channels;
    bool has_levels = false;  ///< tiled, all of them with the first one's texels
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
};

inline Bytes made_parts(const std::vector<MadePart>& parts) {
    const TemporaryFolder folder;
    const std::string path = folder / "parts.exr";
    {
        std::vector<Imf::Header> headers;
        for (const MadePart& part : parts) {
            Imf::Header& header = headers.emplace_back(part.image.width(), part.image.height());
            for (const std::string& name : part.channels)
                header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            header.setName(fmt::format("part {}", headers.size()));
            header.setType(part.has_levels ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
            header.compression() = part.compression;
            header.insert("about", Imf::StringAttribute(header.name()));
            if (part.has_levels)
                header.setTileDescription(Imf::TileDescription(4, 4, Imf::MIPMAP_LEVELS));
        }
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(parts.size()),
                                      false, 0);
        for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
            const Image& image = parts[i].image;
            const std::size_t texel = sizeof(float) * image.channels();
            Imf::FrameBuffer buffer;
            for (std::size_t c = 0; c < parts[i].channels.size(); ++c)
                buffer.insert(
                    parts[i].channels[c],
                    Imf::Slice::Make(Imf::FLOAT, image.values().data() + c, V2i(0), image.width(),
                                     image.height(), texel, texel * image.width()));
            if (parts[i].has_levels) {
                Imf::TiledOutputPart part(file, i);
                part.setFrameBuffer(buffer);
                for (int level = 0; level < part.numLevels(); ++level)
                    part.writeTiles(0, part.numXTiles(level) - 1, 0, part.numYTiles(level) - 1,
                                    level);
            } else {
                Imf::OutputPart part(file, i);
                part.setFrameBuffer(buffer);
                part.writePixels(image.height());
            }
        }
    }
    return file_bytes(path);
}

}  // namespace mirrorball
