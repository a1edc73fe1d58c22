#!/usr/bin/python3
"""Tests of check_symbols.py on lines as nm prints them."""

import unittest

import check_symbols


class CheckSymbolsTest(unittest.TestCase):

  def test_what_the_core_may_use_passes(self):
    self.assertEqual([], check_symbols.complaints("""
terrain.cc.o:
0000000000000010 T terrane::core::Terrain::Create(terrane::core::TerrainSpec)
                 U absl::lts_20220623::Status::~Status()
                 U floor
                 U sqrt
                 U ldexp
0000000000000000 W std::vector<float>::~vector()
0000000000000040 t terrane::core::(anonymous namespace)::exp(double)
"""))

  def test_each_unwanted_symbol_is_found(self):
    for line in ("                 U grpc::ByteBuffer::Clear()",
                 "                 U grpc_channel_destroy",
                 "                 U google::protobuf::Message::Clear()",
                 "0000000000000000 W spdlog::logger::log(int)",
                 "                 U terrane::v1::Frame::Frame()",
                 "                 U socket@GLIBC_2.2.5",
                 "                 U fopen64",
                 "                 U std::basic_filebuf<char>::open(char*)",
                 "                 U exp", "                 U log2f",
                 "                 U pow@GLIBC_2.29", "                 U sincosf"):
      with self.subTest(line=line):
        found = check_symbols.complaints(f"a.cc.o:\n{line}\n")
        self.assertEqual(1, len(found))
        self.assertTrue(found[0].startswith("a.cc.o: "), found[0])


if __name__ == "__main__":
  unittest.main()
