// Times Embree 3 on the rays that `cargo bench --bench tracing -- --dump DIR` writes.
//
//   g++ -O3 -march=x86-64-v3 benches/peers/embree.cpp -o embree -lembree3
//   ./embree DIR isa=avx2        (or isa=sse4.2: the instruction set Embree itself uses)
//
// For every NAME.mesh in DIR: M rays/s of one thread, by single rays and by packets of 4, 8 and 16, coherent.
#include <embree3/rtcore.h>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

struct Float3 { float x, y, z; };
struct RayIn { Float3 origin, direction; float far; };

template <class T> std::vector<T> read(const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    std::vector<T> out(file ? size_t(file.tellg()) / sizeof(T) : 0);
    file.seekg(0);
    file.read(reinterpret_cast<char*>(out.data()), out.size() * sizeof(T));
    return out;
}

static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <int N, class RayHit> void fill(RayHit& p, const RayIn* rays, int count, int* valid, float start) {
    for (int i = 0; i < N; i++) {
        const RayIn& r = rays[std::min(i, count - 1)];
        valid[i] = i < count ? -1 : 0;
        p.org_x[i] = r.origin.x; p.org_y[i] = r.origin.y; p.org_z[i] = r.origin.z;
        p.dir_x[i] = r.direction.x; p.dir_y[i] = r.direction.y; p.dir_z[i] = r.direction.z;
        p.tnear[i] = start; p.tfar[i] = r.far; p.time[i] = 0; p.mask[i] = -1; p.id[i] = i; p.flags[i] = 0;
    }
}

static size_t hits;

template <int N> void packets(RTCScene scene, const std::vector<RayIn>& rays, bool shadow, RTCIntersectContext& c) {
    alignas(64) int valid[16];
    for (size_t i = 0; i < rays.size(); i += N) {
        int count = int(std::min<size_t>(N, rays.size() - i));
        if constexpr (N == 4) {
            RTCRayHit4 p; fill<4>(p.ray, &rays[i], count, valid, shadow ? 1e-4f : 0.f);
            for (int k = 0; k < 4; k++) p.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            if (shadow) rtcOccluded4(valid, scene, &c, &p.ray); else rtcIntersect4(valid, scene, &c, &p);
            for (int k = 0; k < count; k++) hits += shadow ? p.ray.tfar[k] < 0 : p.hit.geomID[k] == 0;
        } else if constexpr (N == 8) {
            RTCRayHit8 p; fill<8>(p.ray, &rays[i], count, valid, shadow ? 1e-4f : 0.f);
            for (int k = 0; k < 8; k++) p.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            if (shadow) rtcOccluded8(valid, scene, &c, &p.ray); else rtcIntersect8(valid, scene, &c, &p);
            for (int k = 0; k < count; k++) hits += shadow ? p.ray.tfar[k] < 0 : p.hit.geomID[k] == 0;
        } else {
            RTCRayHit16 p; fill<16>(p.ray, &rays[i], count, valid, shadow ? 1e-4f : 0.f);
            for (int k = 0; k < 16; k++) p.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            if (shadow) rtcOccluded16(valid, scene, &c, &p.ray); else rtcIntersect16(valid, scene, &c, &p);
            for (int k = 0; k < count; k++) hits += shadow ? p.ray.tfar[k] < 0 : p.hit.geomID[k] == 0;
        }
    }
}

static void singles(RTCScene scene, const std::vector<RayIn>& rays, bool shadow, RTCIntersectContext& c) {
    for (const RayIn& r : rays) {
        RTCRayHit p{};
        p.ray.org_x = r.origin.x; p.ray.org_y = r.origin.y; p.ray.org_z = r.origin.z;
        p.ray.dir_x = r.direction.x; p.ray.dir_y = r.direction.y; p.ray.dir_z = r.direction.z;
        p.ray.tnear = shadow ? 1e-4f : 0.f; p.ray.tfar = r.far; p.ray.mask = -1;
        p.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        if (shadow) { rtcOccluded1(scene, &c, &p.ray); hits += p.ray.tfar < 0; }
        else { rtcIntersect1(scene, &c, &p); hits += p.hit.geomID == 0; }
    }
}

template <class F> double median(F run) {
    std::vector<double> times;
    for (int i = 0; i < 7; i++) { double start = now(); run(); times.push_back(now() - start); }
    std::sort(times.begin(), times.end());
    return times[3];
}

int main(int argc, char** argv) {
    std::string folder = argc > 1 ? argv[1] : ".";
    std::string config = std::string("threads=1,") + (argc > 2 ? argv[2] : "");
    RTCDevice device = rtcNewDevice(config.c_str());
    printf("%s\n%-8s %-7s %9s | %7s %7s %7s %7s | %6s\n", config.c_str(), "mesh", "rays", "build ms", "1", "4", "8", "16", "hit");
    std::vector<std::string> names;
    for (auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".mesh") names.push_back(entry.path().stem());
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) {
        auto corners = read<Float3>(folder + "/" + name + ".mesh");
        double start = now();
        RTCScene scene = rtcNewScene(device);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, corners.size());
        memcpy(vertices, corners.data(), corners.size() * 12);
        auto* indices = (unsigned*)rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, corners.size() / 3);
        for (size_t i = 0; i < corners.size(); i++) indices[i] = unsigned(i);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcCommitScene(scene);
        double build = 1e3 * (now() - start);
        for (const char* kind : {"primary", "shadow"}) {
            bool shadow = !strcmp(kind, "shadow");
            auto rays = read<RayIn>(folder + "/" + name + "." + kind);
            if (rays.empty()) continue;
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
            double seconds[4] = {
                median([&] { hits = 0; singles(scene, rays, shadow, context); }),
                median([&] { hits = 0; packets<4>(scene, rays, shadow, context); }),
                median([&] { hits = 0; packets<8>(scene, rays, shadow, context); }),
                median([&] { hits = 0; packets<16>(scene, rays, shadow, context); }),
            };
            printf("%-8s %-7s %9.0f |", name.c_str(), kind, build);
            for (double s : seconds) printf(" %7.1f", rays.size() / s * 1e-6);
            printf(" | %5.1f%%\n", 100.0 * hits / rays.size());
        }
        rtcReleaseScene(scene);
        rtcReleaseGeometry(geometry);
    }
}
