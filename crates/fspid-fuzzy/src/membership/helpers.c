static double fspid_square(double x) { return x * x; }

/* 0 where x has overflowed, and for NaN. */
static double fspid_one_over_one_plus(double x) {
    return x < 1.7976931348623157e308 ? 1.0 / (1.0 + x) : 0.0;
}

/* Two parabolas from 0 to 1. */
static double fspid_smooth(double t) {
    return t < 0.5 ? 2.0 * (t * t) : 1.0 - 2.0 * ((1.0 - t) * (1.0 - t));
}

static double fspid_smooth_s(double x, double foot, double shoulder) {
    double middle = 0.5 * foot + 0.5 * shoulder;
    double from = fmin(foot, middle), to = fmax(shoulder, middle);
    if (!(x < to)) return x >= to ? 1.0 : 0.0;
    return fspid_smooth(fmax(0.0, (x - from) / fmax(5e-324, to - from)));
}

static double fspid_smooth_z(double x, double shoulder, double foot) {
    double middle = 0.5 * shoulder + 0.5 * foot;
    double from = fmin(shoulder, middle), to = fmax(foot, middle);
    if (!(from < x)) return x <= from ? 1.0 : 0.0;
    return fspid_smooth(fmax(0.0, (to - x) / fmax(5e-324, to - from)));
}

/* Straight from point to point; at a jump the larger of the two grades. */
static double fspid_points(double x, int count, const double *at, const double *grade) {
    double before = grade[count - 1], after = grade[count - 1];
    if (x != x) return 0.0;
    for (int i = count - 2; i >= 0; i--) {
        double width = fmax(5e-324, at[i + 1] - at[i]);
        double share = fmin(1.0, fmax(0.0, (x - at[i]) / width));
        double between = fmin(1.0, fmax(0.0, grade[i] + share * (grade[i + 1] - grade[i])));
        if (x < at[i + 1]) after = between;
        if (!(at[i + 1] < x)) before = between;
    }
    return fmax(before, after);
}
