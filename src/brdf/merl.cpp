// Measured BRDFs of the MERL database.
//
// A value belongs to a cell in Rusinkiewicz's coordinates: the angle of the half vector h to the
// normal (cell edges at 90 (i/90)^2 degrees), and of wi seen from h: the angle to h and the azimuth
// (by reciprocity of period pi). Between the centres of cells we interpolate. Some cells, mostly at
// grazing angles, were not measured; they hold negative numbers and get no say.
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "brdf/half_angle_sampler.h"
#include "brdf/model.h"
#include "io/file.h"

namespace mirrorball {
namespace detail {
namespace {

constexpr int kHalfCount = 90, kDifferenceCount = 90, kAzimuthCount = 180;
constexpr std::size_t kCellCount = std::size_t{kHalfCount} * kDifferenceCount * kAzimuthCount;
constexpr std::size_t kHeaderSize = 3 * sizeof(std::int32_t);
constexpr std::uint64_t kFileSize = kHeaderSize + 3 * kCellCount * sizeof(double);
constexpr double kUnits[] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};  // of R, G and B

struct HalfDifference {
    double half, difference, azimuth;  // radians; azimuth in [0, pi)
};

HalfDifference half_difference(const Vec3d& wi, const Vec3d& wo) {
    const Vec3d h = half_vector(wi, wo);
    const double sine = std::hypot(h.x, h.y);
    // wi turned about z until h is in the plane y = 0, then about y until h is z
    const double c = sine > 0 ? h.x / sine : 1, s = sine > 0 ? h.y / sine : 0;
    const double x = c * wi.x + s * wi.y, y = c * wi.y - s * wi.x;
    const Vec3d difference(h.z * x - sine * wi.z, y, sine * x + h.z * wi.z);
    double azimuth = std::atan2(difference.y, difference.x);
    if (azimuth < 0) azimuth += kPi;
    if (azimuth >= kPi) azimuth -= kPi;
    return {std::atan2(sine, h.z), std::atan2(std::hypot(difference.x, difference.y), difference.z),
            azimuth};
}

// A position between two cells' centres.
struct Between {
    int low, high;
    double share;  // of the higher
};

Between clamped(double position, int count) {
    const double x = std::clamp(position - 0.5, 0.0, count - 1.0);
    const int low = std::min(static_cast<int>(x), count - 2);
    return {low, low + 1, x - low};
}

Between around(double position, int count) {
    const double x = position - 0.5 < 0 ? position - 0.5 + count : position - 0.5;
    const int low = std::min(static_cast<int>(x), count - 1);
    return {low, (low + 1) % count, x - low};
}

class MerlModel : public BrdfModel {
  public:
    MerlModel(std::string path, std::vector<Vec3f> cells)
        : path_(std::move(path)),
          cells_(std::move(cells)),
          sampler_([this](const Vec3d& wi, const Vec3d& wo) {
              const Vec3d f = lookup(wi, wo);
              return f.x + f.y + f.z;
          }) {}

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override { return lookup(wi, wo); }
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        return sampler_.density(wi, wo);
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        return {sampler_.choose(wo, u)};
    }
    std::string text() const override { return "merl:" + path_; }

  private:
    [[nodiscard]] Vec3d lookup(const Vec3d& wi, const Vec3d& wo) const {
        const HalfDifference at = half_difference(wi, wo);
        const Between half = clamped(std::sqrt(at.half * 2 / kPi) * kHalfCount, kHalfCount);
        const Between difference =
            clamped(at.difference * 2 / kPi * kDifferenceCount, kDifferenceCount);
        const Between azimuth = around(at.azimuth / kPi * kAzimuthCount, kAzimuthCount);
        Vec3d sum(0);
        double total = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const bool a = corner & 1, b = corner & 2, c = corner & 4;
            const double weight = (a ? half.share : 1 - half.share) *
                                  (b ? difference.share : 1 - difference.share) *
                                  (c ? azimuth.share : 1 - azimuth.share);
            const std::size_t row = std::size_t(a ? half.high : half.low) * kDifferenceCount +
                                    (b ? difference.high : difference.low);
            const Vec3f& cell = cells_[row * kAzimuthCount + (c ? azimuth.high : azimuth.low)];
            if (cell.x < 0) continue;
            sum += Vec3d(cell) * weight;
            total += weight;
        }
        return total > 0 ? sum / total : Vec3d(0);
    }

    std::string path_;
    std::vector<Vec3f> cells_;  // missing ones negative
    HalfAngleSampler sampler_;
};

void check_header(InputFile& file) {
    if (file.size() < kHeaderSize)
        file.fail(fmt::format("{} bytes; a MERL BRDF has {}", file.size(), kFileSize));
    std::int32_t counts[3];
    for (std::int32_t& count : counts) count = file.read_value<std::int32_t>();
    if (counts[0] != kHalfCount || counts[1] != kDifferenceCount || counts[2] != kAzimuthCount)
        file.fail(fmt::format("its dimensions are {} x {} x {}; a MERL BRDF's are {} x {} x {}",
                              counts[0], counts[1], counts[2], kHalfCount, kDifferenceCount,
                              kAzimuthCount));
    if (file.size() != kFileSize)
        file.fail(fmt::format("{}: {} bytes, a MERL BRDF has {}",
                              file.size() < kFileSize ? "truncated" : "too long", file.size(),
                              kFileSize));
}

std::vector<Vec3f> read_cells(InputFile& file) {
    std::vector<Vec3f> cells(kCellCount);
    std::vector<double> plane(kCellCount);
    for (int c = 0; c < 3; ++c) {
        file.read(std::as_writable_bytes(std::span(plane)));
        for (std::size_t i = 0; i < kCellCount; ++i) {
            const double value = plane[i] * kUnits[c];
            if (!(std::abs(value) <= std::numeric_limits<float>::max()))
                file.fail(fmt::format("value {} of channel {} is {}; expected a finite number",
                                      i + 1, c + 1, plane[i]));
            // a cell that misses one channel misses all
            if (c > 0 && cells[i].x < 0) continue;
            if (value < 0)
                cells[i] = Vec3f(-1);
            else
                cells[i][c] = static_cast<float>(value);
        }
    }
    return cells;
}

}  // namespace

ModelPointer read_merl_model(InputFile& file) {
    check_header(file);
    return std::make_shared<MerlModel>(file.name(), read_cells(file));
}

}  // namespace detail

Brdf read_merl(const std::filesystem::path& path) {
    detail::InputFile file(path);
    return Brdf(detail::read_merl_model(file));
}

}  // namespace mirrorball
