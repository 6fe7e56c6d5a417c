#!/usr/bin/python3
"""raycache render."""
import shutil
import struct
import subprocess
import zlib

from support import PICTURE, RAYCACHE, SCENE, ProgramTest, main


def png_size(data):
    return struct.unpack(">II", data[16:24])


def png_bytes_of_pixels(data):
    """The decompressed scan lines."""
    at, stream = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            stream += data[at + 8:at + 8 + length]
        at += 12 + length
    return zlib.decompress(stream)


class Render(ProgramTest):
    def render(self, name, *arguments):
        result = self.succeeds("render", *SCENE, *PICTURE, "--spp", "2", *arguments, "-o", name)
        self.assertEqual(result.stdout, b"")
        self.assertEqual(self.listing().count(name), 1)
        self.assertFalse([n for n in self.listing() if n.endswith(".partial")])
        return self.path(name).read_bytes()

    def test_a_png_has_the_wanted_size_and_is_neither_black_nor_of_one_colour(self):
        data = self.render("picture.png")
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(png_size(data), (64, 48))
        pixels = png_bytes_of_pixels(data)
        self.assertGreater(max(pixels), 100)
        self.assertGreater(len(set(pixels)), 50)

    def test_every_format_has_its_own_header(self):
        for name, magic in (("a.jpg", b"\xff\xd8\xff"), ("b.exr", b"\x76\x2f\x31\x01"), ("c.hdr", b"#?R")):
            with self.subTest(name):
                self.assertEqual(self.render(name)[:len(magic)], magic)

    def test_the_same_command_gives_the_same_bytes_whatever_the_number_of_threads(self):
        one = self.render("one.png", "--threads", "1")
        self.assertEqual(self.render("two.png", "--threads", "2"), one)
        self.assertEqual(self.render("again.png", "--threads", "2"), one)

    def test_strategy_sequence_seed_bounces_and_exposure_change_the_picture(self):
        plain = self.render("plain.png")
        for i, options in enumerate((["--strategy", "coherent"], ["--sequence", "halton"], ["--seed", "2"],
                                     ["--bounces", "0"], ["--bounces-diffuse", "1"], ["--lights", "bsdf"],
                                     ["--exposure", "-3"])):
            with self.subTest(options):
                self.assertNotEqual(self.render(f"{i}.png", *options), plain)

    def test_a_view_from_elsewhere_is_another_picture(self):
        plain = self.render("plain.png")
        self.assertNotEqual(self.render("moved.png", "--eye", "3,6,4", "--look-at", "0,1,-2"), plain)
        self.assertNotEqual(self.render("narrow.png", "--fov", "15"), plain)

    def test_without_the_module_for_images_nothing_is_rendered_and_all_else_works(self):
        alone = self.path("raycache")
        shutil.copy(RAYCACHE, alone)
        done = subprocess.run([alone, "render", *SCENE, *PICTURE, "--spp", "2", "-o", "a.png"], cwd=self.folder,
                              capture_output=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (1, b""))
        self.assertRegex(done.stderr.decode(), r"\Araycache: error: libraycache_images\.so: .*\n\Z")
        self.assertEqual(self.listing(), ["raycache"])
        listed = subprocess.run([alone, "list", "scenes"], capture_output=True, check=False)
        self.assertEqual((listed.returncode, listed.stderr), (0, b""))

    def test_an_existing_picture_is_replaced(self):
        self.path("picture.png").write_bytes(b"old")
        self.assertEqual(self.render("picture.png")[:4], b"\x89PNG")


if __name__ == "__main__":
    main()
