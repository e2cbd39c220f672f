#include "surface/mesh/uv_topology.h"

namespace relief {

UvTopology join_uvs(const Polygons& polygons, const std::vector<Vec2f>& uvs) {
    struct Link {
        Vec2f uv;
        uint32_t next;
    };
    std::vector<Link> links;
    std::vector<uint32_t> first(polygons.positions.size(), kNoIndex);
    UvTopology result;
    for (size_t corner = 0; corner < uvs.size(); ++corner) {
        uint32_t* link = &first[polygons.points[corner]];
        while (*link != kNoIndex && !(links[*link].uv == uvs[corner])) link = &links[*link].next;
        if (*link == kNoIndex) {
            *link = uint32_t(links.size());
            result.indices.push_back(int(links.size()));
            links.push_back({uvs[corner], kNoIndex});
        } else {
            result.indices.push_back(int(*link));
        }
    }
    for (const Link& link : links) result.values.push_back(link.uv);
    return result;
}

} // namespace relief
