// The mannequin, sculpted: each function adds a part to the distance d. They take p, or p mirrored to the left as
// `side`. A head of 0.225 m from chin to vertex, its eyes at half of that; the braincase is 0.197 m deep and 0.156 m
// wide; brow, base of the nose and chin are a third of the face apart (Farkas, Anthropometry of the Head and Face,
// 1994).
#include "head.h"

namespace
{

// An egg, blunt end behind.
double braincase(Vec p)
{
    return superellipsoid(p - Vec{0, 0.0110, -0.0010}, {0.0765 * (1 - 0.8 * p.z), 0.0890, 0.0975}, 2.18);
}

// Without nose, eyes and lips: a stack of ovals whose half width and foremost point are drawn from the front and in
// profile, cut off below along the jaw.
double face(Vec p)
{
    static constexpr std::array<std::array<double, 2>, 9> kHalfWidth{{{-0.128, 0.0200},
                                                                      {-0.115, 0.0370},
                                                                      {-0.098, 0.0462},
                                                                      {-0.080, 0.0525},
                                                                      {-0.060, 0.0605},
                                                                      {-0.032, 0.0665},
                                                                      {-0.010, 0.0660},
                                                                      {0.010, 0.0640},
                                                                      {0.040, 0.0600}}};
    static constexpr std::array<std::array<double, 2>, 10> kProfile{{{-0.128, 0.0900},
                                                                     {-0.112, 0.1000},
                                                                     {-0.097, 0.0975},
                                                                     {-0.085, 0.1000},
                                                                     {-0.072, 0.1008},
                                                                     {-0.060, 0.0988},
                                                                     {-0.040, 0.0930},
                                                                     {-0.012, 0.0930},
                                                                     {0.004, 0.0962},
                                                                     {0.040, 0.0900}}};
    constexpr double kMiddle = 0.0100;
    const Vec radii{curve(kHalfWidth, p.y), 0, curve(kProfile, p.y) - kMiddle};
    double d = superellipsoid({p.x, 0, p.z - kMiddle}, radii, 2.2);
    const Vec chin{0, -0.1260, 0.0850}, below = normalize({0, -0.96, -0.28});
    d = smooth_max(d, dot(p - chin, below) + 4 * p.x * p.x, 0.022);
    return smooth_max(d, p.y - 0.030, 0.040);
}

double with_face(double d, Vec p, Vec side)
{
    d = smooth_min(d, face(p), 0.034);
    d -= 0.0034 * bump(side, {0.0490, -0.0340, 0.0640}, {0.018, 0.012, 0.022}); // cheekbones
    d -= 0.0020 * bump(side, {0.0260, 0.0075, 0.0900}, {0.022, 0.008, 0.020});  // brows
    d += 0.0016 * bump(side, {0.0620, 0.0120, 0.0520}, {0.018, 0.022, 0.022});  // temples
    d += 0.0016 * bump(side, {0.0460, -0.0700, 0.0600}, {0.018, 0.020, 0.026}); // cheeks
    d -= 0.0014 * bump(p, {0, -0.1120, 0.0980}, {0.016, 0.011, 0.016});         // chin
    return d;
}

double with_eye(double d, Vec side)
{
    d = smooth_max(d, -ellipsoid(side, {0.0330, -0.0135, 0.1060}, {0.0210, 0.0130, 0.0185}), 0.016);
    const Vec eye{0.0315, -0.0150, 0.0762};
    d = smooth_min(d, ellipsoid(side, eye, {0.0158, 0.0132, 0.0140}), 0.006);
    // The closed lids meet in an arc that hangs a little; the upper one has the thicker edge, and a fold above.
    const Vec p = side - eye;
    const double across = p.x / 0.0155;
    const double front = ramp(0.002, 0.009, p.z) * (1 - ramp(0.75, 1.15, std::abs(across)));
    const double line = p.y + 0.0058 - 0.0042 * across * across;
    d -= 0.0005 * front * bump((line - 0.0014) / 0.0016);
    d += 0.0010 * front * bump((line + 0.0004) / 0.0011);
    const double fold = p.y - 0.0072 + 0.0045 * across * across;
    d += 0.0006 * front * bump(fold / 0.0017);
    return d;
}

double with_nose(double d, Vec p, Vec side)
{
    double nose = capsule(p, {0, -0.0040, 0.0890}, 0.0074, {0, -0.0450, 0.1102}, 0.0080);
    nose = smooth_min(nose, ellipsoid(p, {0, -0.0480, 0.1108}, {0.0090, 0.0078, 0.0086}), 0.010);
    nose = smooth_min(nose, ellipsoid(side, {0.0106, -0.0530, 0.1012}, {0.0058, 0.0067, 0.0098}), 0.009);
    nose = smooth_min(nose, capsule(p, {0, -0.0545, 0.1110}, 0.0034, {0, -0.0605, 0.1010}, 0.0040), 0.006);
    nose = smooth_max(nose, -ellipsoid(side, {0.0062, -0.0596, 0.1055}, {0.0027, 0.0032, 0.0055}), 0.003);
    nose += 0.0005 * bump(side, {0.0118, -0.0462, 0.1050}, {0.0050, 0.0016, 0.0060}); // over the wings
    return smooth_min(d, nose, 0.012);
}

double with_mouth(double d, Vec p)
{
    const double across = p.x / 0.0240;
    const double smile = 0.0018 * across * across;                             // how far the corners are raised
    const double bow = 0.0010 * std::cos(p.x / 0.0240 * 2 * std::numbers::pi); // cupid's bow
    const Vec q{p.x, p.y - smile, p.z + 15 * p.x * p.x};                       // lips lie round the teeth
    d += 0.0010 * bump(p, {0, -0.0675, 0.1020}, {0.0034, 0.0070, 0.012});      // philtrum
    d = smooth_min(d, ellipsoid(q, {0, -0.0775 - bow, 0.0982}, {0.0235, 0.0052, 0.0070}), 0.005);
    d = smooth_min(d, ellipsoid(q, {0, -0.0870, 0.0972}, {0.0192, 0.0064, 0.0078}), 0.006);
    const double line = q.y + 0.0816 + 0.6 * bow;
    const double slit = 0.0016 * (1 - ramp(0.70, 1.15, std::abs(across))) * ramp(0.06, 0.08, p.z);
    return d + slit * bump(line / 0.0014);
}

// An ear lies in the plane of its local x (backwards) and y (up); z points away from the head. `yaw` makes it stand off
// the head, `pitch` follows the braincase's slope.
double with_ear(double d, Vec side)
{
    const double yaw = 65 * kDegree, pitch = 5 * kDegree, lean = 0.20;
    const Vec p = side - Vec{0.0775, -0.0290, -0.0160};
    if (length(p) > 0.06)
        return d;
    const double out = std::sin(yaw) * p.x + std::cos(yaw) * p.z;
    const double up = std::cos(pitch) * p.y + std::sin(pitch) * out;
    const Vec q{std::cos(yaw) * p.x - std::sin(yaw) * p.z - lean * up, up,
                std::cos(pitch) * out - std::sin(pitch) * p.y};
    // The rim follows an ellipse; its nearest point is taken to be the one in the same stretched direction.
    constexpr double kAcross = 0.0140, kAlong = 0.0255;
    const Vec stretched{q.x / kAcross, q.y / kAlong, 0};
    const double round = std::max(length(stretched), 1e-3);
    const Vec rim{q.x / round, q.y / round, 0.0008};
    double ear = length(q - rim) - 0.0034;
    // Solid behind, or it would be too thin for the net.
    const double plate = smooth_max((round - 1.2) * kAcross, std::abs(q.z + 0.0065) - 0.0073, 0.006);
    ear = smooth_min(ear, plate, 0.004);
    ear = smooth_max(ear, -ellipsoid(q, {-0.0030, -0.0060, 0.0010}, {0.0070, 0.0085, 0.0075}), 0.004);    // its bowl
    ear = smooth_min(ear, capsule(q, {0.002, 0.013, 0.0}, 0.0026, {0.0055, -0.003, 0.0}, 0.0034), 0.003); // inner fold
    ear = smooth_min(ear, capsule(q, {0.0055, -0.003, 0.0}, 0.0034, {-0.002, -0.013, 0.0}, 0.0030), 0.004);
    ear = smooth_min(ear, ellipsoid(q, {-0.003, -0.023, 0.000}, {0.0085, 0.0090, 0.0050}), 0.008); // lobe
    ear = smooth_min(ear, ellipsoid(q, {-0.0125, -0.006, 0.001}, {0.0045, 0.0065, 0.0045}), 0.006);
    return smooth_min(d, ear, 0.006);
}

double with_neck_and_shoulders(double d, Vec p, Vec side)
{
    double neck = capsule({p.x, p.y, p.z * 0.95}, {0, -0.070, -0.0200}, 0.0480, {0, -0.205, -0.0380}, 0.0490);
    // The muscles from behind the ears to the pit of the throat.
    neck =
        smooth_min(neck, capsule(side, {0.0500, -0.0720, -0.0260}, 0.0110, {0.0130, -0.2100, 0.0080}, 0.0075), 0.018);
    double bust = capsule(side, {0.0, -0.180, -0.0450}, 0.0400, {0.140, -0.2380, -0.0400}, 0.0420);
    bust = smooth_min(bust, ellipsoid(p, {0, -0.275, -0.0250}, {0.150, 0.075, 0.0700}), 0.050);
    bust =
        smooth_min(bust, capsule(side, {0.0200, -0.2190, 0.0190}, 0.0050, {0.1200, -0.2080, -0.0200}, 0.0060), 0.020);
    bust = smooth_min(neck, bust, 0.055);
    bust += 0.004 * bump(p, {0, -0.2120, 0.0260}, {0.013, 0.013, 0.02});
    const double cut =
        std::pow(std::pow(std::abs(p.x) / 0.165, 3) + std::pow(std::abs(p.y + 0.150) / 0.135, 3), 1 / 3.0);
    bust = smooth_max(bust, (cut - 1) * 0.135, 0.006);
    return smooth_min(d, bust, 0.028);
}

} // namespace

double head(Vec p)
{
    // The left half, mirrored; rounded at the middle, so that what crosses it has no crease there.
    const double soft = 0.002;
    const Vec side{std::sqrt(p.x * p.x + soft * soft) - soft, p.y, p.z};
    double d = braincase(p);
    d = with_face(d, p, side);
    d = with_eye(d, side);
    d = with_mouth(d, p);
    d = with_nose(d, p, side);
    d = with_neck_and_shoulders(d, p, side);
    return with_ear(d, side);
}

// Forehead with the temples' recessions, sideburn, over the ear, down behind it, nape.
double inside_hairline(Vec p)
{
    static constexpr std::array<std::array<double, 2>, 13> kHeight{{{0, 0.0645}, // azimuth in degrees from the face, m
                                                                    {20, 0.0655},
                                                                    {36, 0.0640},
                                                                    {48, 0.0510},
                                                                    {60, 0.0290},
                                                                    {70, 0.0060},
                                                                    {77, -0.0160},
                                                                    {85, -0.0150},
                                                                    {94, 0.0080},
                                                                    {110, 0.0080},
                                                                    {122, -0.0200},
                                                                    {142, -0.0590},
                                                                    {180, -0.0715}}};
    return p.y - curve(kHeight, std::atan2(std::abs(p.x), p.z) / kDegree);
}
