// Median of nine by 19 exchanges (Smith 1996), of numbers or of vectors of them.
#ifndef MEDIAN_OF
#define MEDIAN_OF uint
#endif
#define ORDER(a, b)                \
    {                              \
        MEDIAN_OF low = min(a, b); \
        b = max(a, b);             \
        a = low;                   \
    }
MEDIAN_OF median9(MEDIAN_OF p0, MEDIAN_OF p1, MEDIAN_OF p2, MEDIAN_OF p3, MEDIAN_OF p4, MEDIAN_OF p5, MEDIAN_OF p6,
                  MEDIAN_OF p7, MEDIAN_OF p8) {
    ORDER(p1, p2) ORDER(p4, p5) ORDER(p7, p8) ORDER(p0, p1) ORDER(p3, p4) ORDER(p6, p7)
    ORDER(p1, p2) ORDER(p4, p5) ORDER(p7, p8) ORDER(p0, p3) ORDER(p5, p8) ORDER(p4, p7)
    ORDER(p3, p6) ORDER(p1, p4) ORDER(p2, p5) ORDER(p4, p7) ORDER(p4, p2) ORDER(p6, p4)
    ORDER(p4, p2)
    return p4;
}
