// Drives the Verilated chip alone, without testbench and vectors, and prints samples per second.
//
// Codes come from the file codes.txt, a pair a line, and are played again and again.
#include <chrono>
#include <cstdio>
#include <vector>

#include "Vchip.h"
#include "verilated.h"

static void clock(Vchip& chip) {
    chip.clk = 1;
    chip.eval();
    chip.clk = 0;
    chip.eval();
}

int main(int argc, char** argv) {
    Verilated::commandArgs(argc, argv);
    std::vector<unsigned> codes;
    FILE* file = std::fopen("codes.txt", "r");
    if (!file) return 2;
    for (unsigned code; std::fscanf(file, "%x", &code) == 1;) codes.push_back(code);
    std::fclose(file);
    if (codes.size() < 2) return 2;

    Vchip chip;
    chip.clk = 0;
    chip.rst_n = 0;
    chip.sample_valid = 0;
    chip.preset = 0;
    chip.calibrate = 1;
    chip.eval();
    chip.rst_n = 1;
    double least = 1e9;
    long samples = 0;
    unsigned long all = 0;
    for (int repeat = 0; repeat < 10; ++repeat) {
        const auto start = std::chrono::steady_clock::now();
        samples = 0;
        for (int pass = 0; pass < 10; ++pass) {
            for (std::size_t i = 0; i + 1 < codes.size(); i += 2, ++samples) {
                chip.adc_cos = codes[i];
                chip.adc_sin = codes[i + 1];
                chip.sample_valid = 1;
                clock(chip);
                chip.sample_valid = 0;
                for (int waited = 0; !chip.valid; ++waited) {
                    if (waited > 1000) return 1;
                    clock(chip);
                }
                all += chip.speed;
            }
        }
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        if (took.count() < least) least = took.count();
    }
    // Speed and lock are printed: the compiler can leave nothing out, and a chip that does not follow is seen.
    std::printf("%.0f %d %lu\n", samples / least, chip.locked, all);
    return 0;
}
