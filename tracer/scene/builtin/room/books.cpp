// The shelf and all that stands in it: rows of books, some leaning, some lying, with their pages and spines.
#include <array>

#include "tracer/scene/builtin/modelling/random.hpp"
#include "tracer/scene/builtin/room/parts.hpp"

namespace raycache::tracer::room {
namespace {

constexpr int rows = 6, columns = 3;
constexpr float board = 0.024F;
constexpr std::array<Stuff, 7> bindings{Stuff::book_red,   Stuff::book_blue, Stuff::book_green, Stuff::book_black,
                                        Stuff::book_ochre, Stuff::paper,     Stuff::canvas};

/// Stands at the origin with its spine towards +Z: X thickness, Y height, Z depth.
void book(MeshBuilder& b, Vec3 size, Stuff binding, Fineness fine) {
    b.use(Stuff::paper);
    box(b, {0.003F, 0.003F, 0.002F}, {size.x - 0.003F, size.y - 0.003F, size.z - 0.004F});
    b.use(binding);
    const float cover = 0.0025F;
    box(b, {0, 0, 0}, {cover, size.y, size.z - 0.004F});
    box(b, {size.x - cover, 0, 0}, {size.x, size.y, size.z - 0.004F});
    // The spine bulges a little.
    sheet(b, fine.of(4, 2), fine.of(2, 1), [&](float u, float v) {
        const float x = 2 * u - 1;
        return Vec3{size.x * u, size.y * v, size.z - 0.004F + 0.16F * size.x * (1 - x * x)};
    });
    if (binding == Stuff::canvas || binding == Stuff::paper) return;
    b.use(Stuff::brass);  // two bands on the spine
    for (const float level : {0.2F, 0.82F}) {
        const float y = size.y * level, out = size.z - 0.003F + 0.16F * size.x;
        sheet(b, fine.of(4, 2), 1, [&](float u, float v) {
            const float x = 2 * u - 1;
            return Vec3{size.x * u, y + 0.004F * v, out - 0.16F * size.x * x * x + 0.0006F};
        });
    }
}

/// A turn about Z to the right, the lower corner of a book so thick on the board.
Transform leaning(float thick) {
    constexpr float sine = 0.22F, cosine = 0.9755F;
    return {{cosine, -sine, 0}, {sine, cosine, 0}, {0, 0, 1}, {0, sine * thick, 0}};
}

/// Books on one board from `from` on, `length` long.
void row_of_books(MeshBuilder& b, Vec3 from, float length, float space, Random& random, Fineness fine) {
    const Transform outer = b.frame();
    float x = 0.004F;
    while (true) {
        const float thick = random.in(0.014F, 0.052F), tall = space * random.in(0.62F, 0.93F);
        const float deep = random.in(0.17F, 0.24F);
        const bool lean = random.below(14) == 0;
        const float room = thick + (lean ? 0.24F * tall : 0.0015F);
        if (x + room > length - 0.01F) break;
        const Stuff binding = bindings[random.below(bindings.size())];
        const Transform place = moved(from + Vec3{x, 0, random.in(0, 0.02F)});
        b.frame(outer * place * (lean ? leaning(thick) : Transform{}));
        book(b, {thick, tall, deep}, binding, fine);
        x += room;
    }
    b.frame(outer);
}

/// A heap of books that lie.
void pile(MeshBuilder& b, Vec3 at, int number, Random& random, Fineness fine) {
    const Transform outer = b.frame();
    float y = 0;
    for (int i = 0; i < number; ++i) {
        const float thick = random.in(0.016F, 0.04F), tall = random.in(0.22F, 0.3F), deep = random.in(0.16F, 0.22F);
        const double turn = static_cast<double>(random.in(-0.04F, 0.04F));
        const Stuff binding = bindings[random.below(bindings.size())];
        // Its height along X, its thickness up.
        b.frame(outer * moved(at + Vec3{0, y + thick, 0}) * turned(turn) *
                Transform{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}, {-tall / 2, 0, -deep / 2}});
        book(b, {thick, tall, deep}, binding, fine);
        y += thick;
    }
    b.frame(outer);
}

}  // namespace

void books(MeshBuilder& b, Fineness fine) {
    Random random(331);
    const Vec3 from = shelf_from, to = shelf_to;
    const float step = (to.y - 0.06F) / rows, bay = (to.x - from.x - board) / columns;
    b.use(Stuff::walnut);
    for (int c = 0; c <= columns; ++c) {
        const float x = from.x + bay * static_cast<float>(c);
        textured_box(b, {x, 0, from.z}, {x + board, to.y, to.z}, 0.8F);
    }
    for (int c = 0; c < columns; ++c)
        for (int r = 0; r <= rows; ++r) {
            const float x = from.x + bay * static_cast<float>(c) + board, y = 0.05F + step * static_cast<float>(r);
            textured_box(b, {x, y - board, from.z}, {x + bay - board, y, to.z - 0.005F}, 0.8F);
        }
    b.use(Stuff::dark_wood);
    flat(b, {from.x, 0, from.z}, {to.x, 0, from.z}, {to.x, to.y, from.z}, {from.x, to.y, from.z});
    for (int c = 0; c < columns; ++c)
        for (int r = 0; r < rows; ++r) {
            const Vec3 corner{from.x + bay * static_cast<float>(c) + board, 0.05F + step * static_cast<float>(r),
                              from.z + 0.03F};
            const float space = step - board, length = bay - board;
            const bool heap = (c + 2 * r) % 5 == 1;
            row_of_books(b, corner, heap ? length * 0.5F : length, space, random, fine);
            if (heap) pile(b, corner + Vec3{length * 0.76F, 0, 0.12F}, 5, random, fine);
        }
    pile(b, coffee_table_at + Vec3{-0.34F, coffee_height + 0.001F, 0.08F}, 3, random, fine);
    pile(b, coffee_table_at + Vec3{0.2F, 0.146F, 0}, 6, random, fine);
    pile(b, sideboard_to + Vec3{-0.22F, 0, -1.3F}, 4, random, fine);
}

}  // namespace raycache::tracer::room
