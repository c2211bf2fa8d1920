// Measured BRDFs: files that the test writes by formula, read back; and every file that is wrong.
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>

#include <gtest/gtest.h>
#include <mirrorball/brdf_properties.h>
#include <mirrorball/error.h>

#include "brdf/brdf_support.h"
#include "support.h"

namespace mirrorball {
namespace {

void expect_unreadable(const std::function<void()>& read, const std::string& message) {
    try {
        read();
        ADD_FAILURE() << "read: " << message;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::cannot_read) << error.what();
        EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
}

constexpr int kCellCount = 90 * 90 * 180;
constexpr double kUnits[] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

// A smooth highlight on a diffuse base, in the coordinates of the format; each channel its own.
double formula(double half, double difference, double azimuth, int channel) {
    return 0.1 * (channel + 1) + 2 * std::exp(-half * half / 0.05) +
           0.05 * difference * (1 + 0.3 * std::cos(2 * azimuth - 1));
}

// A file of the formula at the centres of its cells, written once for all tests; those beyond 80
// degrees of difference are missing.
class Merl : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        std::ofstream file(path(), std::ios::binary);
        const std::int32_t header[] = {90, 90, 180};
        file.write(reinterpret_cast<const char*>(header), sizeof header);
        std::vector<double> plane(kCellCount);
        for (int channel = 0; channel < 3; ++channel) {
            for (int h = 0, i = 0; h < 90; ++h) {
                const double half = std::pow((h + 0.5) / 90, 2) * kPi / 2;
                for (int d = 0; d < 90; ++d) {
                    const double difference = (d + 0.5) / 90 * kPi / 2;
                    for (int a = 0; a < 180; ++a, ++i)
                        plane[i] = d >= 80
                                       ? -0.5
                                       : formula(half, difference, (a + 0.5) / 180 * kPi, channel) /
                                             kUnits[channel];
                }
            }
            file.write(reinterpret_cast<const char*>(plane.data()),
                       static_cast<std::streamsize>(plane.size() * sizeof(double)));
        }
        brdf_ = std::make_unique<Brdf>(parse_brdf("merl:" + path().string()));
    }
    static void TearDownTestSuite() {
        brdf_.reset();
        folder_.reset();
    }
    static std::filesystem::path path() { return folder_->path() / "paint+glow.binary"; }

    // wi and wo from the format's coordinates: wo is wi mirrored at h.
    static std::pair<Vec3d, Vec3d> directions(double half, double difference, double azimuth) {
        const double sine = std::sin(difference);
        const Vec3d d(sine * std::cos(azimuth), sine * std::sin(azimuth), std::cos(difference));
        const auto tilted = [&](const Vec3d& w) {
            return Vec3d(std::cos(half) * w.x + std::sin(half) * w.z, w.y,
                         std::cos(half) * w.z - std::sin(half) * w.x);
        };
        return {tilted(d), tilted({-d.x, -d.y, d.z})};
    }

    // Writes what `change` makes of the file's first bytes to a copy, cut or stretched to `size`.
    static std::filesystem::path wrong_file(const std::string& bytes, std::uintmax_t size) {
        const std::filesystem::path wrong = folder_->path() / "wrong.binary";
        std::ofstream(wrong, std::ios::binary) << bytes;
        std::filesystem::resize_file(wrong, size);  // sparse: takes no time and no space
        return wrong;
    }

    static std::unique_ptr<TemporaryFolder> folder_;
    static std::unique_ptr<Brdf> brdf_;
};
std::unique_ptr<TemporaryFolder> Merl::folder_;
std::unique_ptr<Brdf> Merl::brdf_;

TEST_F(Merl, CellsAreWhereTheFormatHasThem) {
    for (const int h : {0, 7, 40, 60}) {
        for (const int d : {1, 20, 33}) {
            for (const int a : {0, 44, 90, 179}) {
                const double half = std::pow((h + 0.5) / 90, 2) * kPi / 2,
                             difference = (d + 0.5) / 90 * kPi / 2, azimuth = (a + 0.5) / 180 * kPi;
                const auto [wi, wo] = directions(half, difference, azimuth);
                if (wi.z <= 0.01 || wo.z <= 0.01) continue;
                const Vec3d f = brdf_->evaluate(wi, wo);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(f[c], formula(half, difference, azimuth, c), 2e-6)
                        << h << " " << d << " " << a;
            }
        }
    }
}

TEST_F(Merl, InterpolatesBetweenCells) {
    // lines over steps of a degree: errors are second differences
    for (const double half : {0.05, 0.3, 0.7}) {
        for (const double azimuth : {0.001, 1.0, 3.13}) {
            const auto [wi, wo] = directions(half, 0.4, azimuth);
            EXPECT_NEAR(brdf_->evaluate(wi, wo).y, formula(half, 0.4, azimuth, 1), 2e-3);
        }
    }
}

// Between 79 and 81 cells only the measured side speaks; beyond there is nothing.
TEST_F(Merl, MissingValuesHaveNoSay) {
    const double half = std::pow(5.5 / 90, 2) * kPi / 2, last = 79.5 / 90 * kPi / 2;
    const double step = kPi / 180;
    const auto at = [&](double difference) {
        const auto [wi, wo] = directions(half, difference, kPi / 2);
        return brdf_->evaluate(wi, wo).x;
    };
    EXPECT_NEAR(at(last + 0.7 * step), at(last), 1e-6);
    EXPECT_GT(at(last), 0.1);
    EXPECT_EQ(at(last + 2 * step), 0);
}

TEST_F(Merl, KeepsItsLaws) {
    const BrdfProperties p = measure_brdf(*brdf_, {.pair_count = 4096, .point_count = 4096});
    EXPECT_TRUE(p.is_reciprocal()) << p.reciprocity.largest;
    EXPECT_TRUE(p.is_isotropic()) << p.isotropy.largest;
    EXPECT_TRUE(p.is_positive());
}

TEST_F(Merl, SamplesFollowTheirDensity) {
    for (const Vec3d& wo : kViews) {
        double integral = 0;
        for (int patch = 0; patch < 32 * 32; ++patch) {
            const double z = patch / 32 / 16.0 - 1, azimuth = patch % 32 * kPi / 16;
            integral += integrate_patch([&](const Vec3d& wi) { return brdf_->density(wi, wo); }, z,
                                        z + 1 / 16.0, azimuth, azimuth + kPi / 16, 1e-5);
        }
        EXPECT_NEAR(integral, 1, 3e-3) << wo;
        const double truth = integrate_hemisphere(
            [&](const Vec3d& wi) { return brdf_->evaluate(wi, wo).x * wi.z; }, 1e-4);
        const Integral mean = furnace_radiance(*brdf_, wo, 1 << 15);
        EXPECT_NEAR(mean.value.x, truth, 4 * mean.error + 1e-3) << wo;
        EXPECT_LT(mean.error, 0.01 * truth) << wo;
    }
}

TEST_F(Merl, TextNamesTheFile) {
    EXPECT_EQ(to_string(*brdf_), "merl:" + path().string());
    // a plus in a name is no sum; one between blanks is
    const Brdf sum = parse_brdf("0.5*merl:" + path().string() + " + 0.5*lambert");
    const Vec3d wi = direction(30, 1), wo = direction(50, 4);
    EXPECT_NEAR(sum.evaluate(wi, wo).x, 0.5 * brdf_->evaluate(wi, wo).x + 0.5 / kPi, 1e-12);
}

TEST_F(Merl, WrongFilesAreRefused) {
    const std::string good("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", 12);
    constexpr std::uintmax_t kSize = 12 + 3 * std::uintmax_t{kCellCount} * 8;
    const auto read = [](const std::filesystem::path& file) {
        return [file] { (void)read_merl(file); };
    };
    expect_unreadable(read(folder_->path() / "absent.binary"), "absent.binary: cannot be opened");
    expect_unreadable(read(wrong_file("", 0)), "0 bytes; a MERL BRDF has 34992012");
    expect_unreadable(read(wrong_file(good, 12)), "truncated: 12 bytes");
    expect_unreadable(read(wrong_file(good, kSize - 1)), "truncated: 34992011 bytes");
    expect_unreadable(read(wrong_file(good, kSize + 8)), "too long: 34992020 bytes");
    std::string other = good;
    other[8] = 90;
    expect_unreadable(read(wrong_file(other, kSize)), "its dimensions are 90 x 90 x 90");
    other[3] = char(0xff);
    expect_unreadable(read(wrong_file(other, kSize)), "its dimensions are -");
    const double nan = std::nan("");
    std::string not_finite = good + std::string(8, '\0');
    not_finite.append(reinterpret_cast<const char*>(&nan), 8);
    expect_unreadable(read(wrong_file(not_finite, kSize)), "value 2 of channel 1 is");
}

class Table : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& text) {
        std::ofstream(folder_ / "cloth.txt") << text;
        return folder_ / "cloth.txt";
    }
    void expect_refused(const std::string& text, const std::string& message) {
        expect_unreadable([file = write(text)] { (void)read_brdf_table(file); },
                          "cloth.txt: " + message);
    }
    TemporaryFolder folder_;
};

// Trilinear in the angles, so what is trilinear comes back exactly; lines in any order.
TEST_F(Table, IsLinearBetweenItsPoints) {
    const auto value = [](double l, double v, double a) {
        return 0.1 + 0.002 * l + 0.001 * v * (1 - a / 180) + 1e-5 * l * v;
    };
    std::string text = "# light view azimuth R G B\n\n";
    for (const int l : {90, 0, 40}) {
        for (const int v : {60, 0}) {
            for (const int a : {0, 180, 90}) {
                const double f = value(l, v, a);
                text += std::to_string(l) + "\t" + std::to_string(v) + " " + std::to_string(a) +
                        " " + std::to_string(f) + " " + std::to_string(2 * f) + " 0.5 # cell\r\n";
            }
        }
    }
    const Brdf brdf = parse_brdf("table:" + write(text).string());
    for (const double l : {1.0, 33.0, 71.0}) {
        for (const double v : {5.0, 59.0}) {
            for (const double a : {0.0, 45.0, 170.0}) {
                const double azimuth = a * kPi / 180;
                for (const double sign : {1.0, -1.0}) {  // isotropic, and the same to both sides
                    const Vec3d f =
                        brdf.evaluate(direction(l, 0.3 + sign * azimuth), direction(v, 0.3));
                    EXPECT_NEAR(f.x, value(l, v, a), 2e-6);
                    EXPECT_NEAR(f.y, 2 * value(l, v, a), 3e-6);
                    EXPECT_NEAR(f.z, 0.5, 1e-6);
                }
            }
        }
    }
    // beyond 60 degrees of view as at 60
    EXPECT_NEAR(brdf.evaluate(direction(40, 0), direction(80, 0)).x, value(40, 60, 0), 2e-6);
    // it is not symmetric in light and view, and the check says so
    const BrdfProperties p = measure_brdf(brdf, {.pair_count = 4096, .point_count = 4096});
    EXPECT_FALSE(p.is_reciprocal());
    EXPECT_TRUE(p.is_isotropic());
    EXPECT_TRUE(p.is_positive());
}

TEST_F(Table, OneLineIsALambert) {
    const Brdf brdf = read_brdf_table(write("0 0 0 0.25\n"));
    EXPECT_NEAR(brdf.evaluate(direction(20, 1), direction(70, 2)).z, 0.25, 1e-12);
    EXPECT_NEAR(furnace_radiance(brdf, direction(30, 0)).value.x, kPi / 4, 1e-3);
    EXPECT_EQ(to_string(brdf), "table:" + (folder_ / "cloth.txt").string());
}

TEST_F(Table, WrongFilesAreRefused) {
    expect_unreadable([this] { (void)read_brdf_table(folder_ / "absent.txt"); }, "absent.txt");
    expect_refused("", "no measurements in it");
    expect_refused("# nothing\n", "no measurements in it");
    expect_refused("0 0 0\n", "line 1: found \"0 0 0\", expected the angles");
    expect_refused("0 0 0 1 2\n", "line 1: found");
    expect_refused("\n0 0 0 1 2 3 4\n", "line 2: found");
    expect_refused("0 0 0 1x\n", "line 1: found");
    expect_refused("0 zero 0 1\n", "line 1: found");
    expect_refused("91 0 0 1\n", "line 1: the light's angle is 91; expected 0 to 90");
    expect_refused("0 -1 0 1\n", "line 1: the view's angle is -1; expected 0 to 90");
    expect_refused("0 0 181 1\n", "line 1: the azimuth is 181; expected 0 to 180");
    expect_refused("0 0 0 -1\n", "line 1: the value is -1");
    expect_refused("0 0 0 nan\n", "line 1: the value is nan");
    expect_refused("0 0 0 1 inf 1\n", "line 1: the value is inf");
    expect_refused("0 0 0 1\n0 0 0 2\n", "line 2: the same angles as line 1");
    expect_refused("0 0 0 1\n0 10 0 1\n20 0 0 1\n",
                   "2 angles of light, 2 of view and 1 azimuths make a grid, but there is no line "
                   "for 20 10 0");
    std::filesystem::resize_file(write("0 0 0 1\n"), (64u << 20) + 1);
    expect_unreadable([this] { (void)read_brdf_table(folder_ / "cloth.txt"); }, "has at most");
}

}  // namespace
}  // namespace mirrorball
