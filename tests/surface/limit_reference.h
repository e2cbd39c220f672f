// The limit surface of a mesh as OpenSubdiv's patch tables evaluate it: another way than that of src/surface.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include "math/vec.h"
#include "relief/scene.h"

namespace relief::test {

struct ReferencePoint {
    Vec3<double> position, normal;
    double sine; ///< of the angle between the derivatives: small where the normal is in doubt
};

class LimitReference {
  public:
    explicit LimitReference(const Mesh& mesh) {
        namespace osd = OpenSubdiv;
        std::vector<int> sizes(mesh.face_sizes.begin(), mesh.face_sizes.end());
        std::vector<int> points(mesh.position_indices.begin(), mesh.position_indices.end());
        std::vector<int> crease_ends, corners;
        std::vector<float> sharpness, corner_sharpness;
        for (const Crease& crease : mesh.creases) {
            if (crease.first == crease.second) {
                corners.push_back(int(crease.first)), corner_sharpness.push_back(crease.sharpness);
                continue;
            }
            crease_ends.insert(crease_ends.end(), {int(crease.first), int(crease.second)});
            sharpness.push_back(crease.sharpness);
        }
        osd::Far::TopologyDescriptor descriptor;
        descriptor.numVertices = int(mesh.positions.size());
        descriptor.numFaces = int(sizes.size());
        descriptor.numVertsPerFace = sizes.data();
        descriptor.vertIndicesPerFace = points.data();
        descriptor.numCreases = int(sharpness.size());
        descriptor.creaseVertexIndexPairs = crease_ends.data();
        descriptor.creaseWeights = sharpness.data();
        descriptor.numCorners = int(corners.size());
        descriptor.cornerVertexIndices = corners.data();
        descriptor.cornerWeights = corner_sharpness.data();
        osd::Sdc::Options options;
        options.SetVtxBoundaryInterpolation(mesh.subdivision.boundary == BoundaryRule::edge_only
                                                ? osd::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                                : osd::Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
        using Factory = osd::Far::TopologyRefinerFactory<osd::Far::TopologyDescriptor>;
        const std::unique_ptr<osd::Far::TopologyRefiner> refiner(
            Factory::Create(descriptor, Factory::Options(osd::Sdc::SCHEME_CATMARK, options)));
        osd::Far::PatchTableFactory::Options table_options(10);
        table_options.useInfSharpPatch = true;
        table_options.SetPatchPrecision<double>();
        table_options.SetEndCapType(osd::Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
        auto adaptive = table_options.GetRefineAdaptiveOptions();
        refiner->RefineAdaptive(adaptive);
        table_.reset(osd::Far::PatchTableFactory::Create(*refiner, table_options));
        map_ = std::make_unique<osd::Far::PatchMap>(*table_);
        const osd::Far::PtexIndices ptex(*refiner);
        for (int face = 0; face < descriptor.numFaces; ++face) first_part_.push_back(ptex.GetFaceId(face));
        refine_points(mesh, *refiner);
    }

    /// (u, v) in [0, 1]^2 of a quad, or of the part of a polygon beside its corner `part`.
    ReferencePoint evaluate(uint32_t face, uint32_t part, double u, double v) const {
        const auto* handle = map_->FindPatch(first_part_[face] + int(part), u, v);
        double weights[20], along_u[20], along_v[20];
        table_->EvaluateBasis(*handle, u, v, weights, along_u, along_v);
        const auto vertices = table_->GetPatchVertices(*handle);
        Vec3<double> p{}, du{}, dv{};
        for (int k = 0; k < vertices.size(); ++k) {
            const Vec3<double>& point = points_[size_t(vertices[k])].value;
            p += point * weights[k], du += point * along_u[k], dv += point * along_v[k];
        }
        const Vec3<double> n = cross(du, dv);
        const double size = std::sqrt(dot(n, n));
        return {p, n * (1 / size), size / std::sqrt(dot(du, du) * dot(dv, dv))};
    }

  private:
    struct Point {
        Vec3<double> value{};
        void Clear(void* = nullptr) { value = {}; }
        void AddWithWeight(const Point& other, double weight) { value += other.value * weight; }
    };

    void refine_points(const Mesh& mesh, const OpenSubdiv::Far::TopologyRefiner& refiner) {
        for (const Vec3f& p : mesh.positions) points_.push_back({{p.x, p.y, p.z}});
        const OpenSubdiv::Far::PrimvarRefinerReal<double> values(refiner);
        std::vector<Point> current = points_;
        for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
            std::vector<Point> next(size_t(refiner.GetLevel(level).GetNumVertices()));
            values.Interpolate(level, current, next);
            points_.insert(points_.end(), next.begin(), next.end());
            current = std::move(next);
        }
        std::vector<Point> local(size_t(table_->GetNumLocalPoints()));
        if (!local.empty()) table_->GetLocalPointStencilTable<double>()->UpdateValues(points_, local);
        points_.insert(points_.end(), local.begin(), local.end());
    }

    std::unique_ptr<OpenSubdiv::Far::PatchTable> table_;
    std::unique_ptr<OpenSubdiv::Far::PatchMap> map_;
    std::vector<int> first_part_;
    std::vector<Point> points_;
};

} // namespace relief::test
