r"""The formulas of the lecture, each written once: in LaTeX, of the part that `plain_formula` reads. Vectors are bold.

They are shipped typeset: after a change, `make formulas` typesets them again.
"""

from enum import StrEnum

_RADICAND = r"1 - n^2(1 - c_1^2)"


class Lecture(StrEnum):
    """A formula or a symbol of the lecture: its value is the source."""

    SNELL = r"n_1 \sin\theta_1 = n_2 \sin\theta_2"
    CRITICAL = r"\theta_c = \arcsin\frac{n_2}{n_1}"
    TRANSMISSION = r"\mathbf{t} = n\,\mathbf{v} + (n c_1 - c_2)\,\mathbf{n}"
    REFLECTION = r"\mathbf{r} = \mathbf{v} - 2 (\mathbf{n}\cdot\mathbf{v})\,\mathbf{n}"
    FRESNEL = r"R = \frac{r_s^2 + r_p^2}{2}"
    LOCAL = (
        r"I = A k_a C + \sum S L \\ "
        r"\left[k_d C (\mathbf{N}\cdot\mathbf{L}) + k_s (\mathbf{R}\cdot\mathbf{V})^p\right]"
    )
    ONE_LIGHT = r"S L \left[k_d C (\mathbf{N}\cdot\mathbf{L}) + k_s (\mathbf{R}\cdot\mathbf{V})^p\right]"
    RADIANCE = r"I = \mathrm{local} + \sum \mathrm{factor}\,\times\,\mathrm{child}"

    ETA = r"n = n_1/n_2"
    COSINE_1 = r"c_1 = {-\mathbf{v}}\cdot\mathbf{n}"
    COSINE_2 = rf"c_2 = \sqrt{{{_RADICAND}}}"
    RADICAND = _RADICAND
    TOO_LARGE = r"n^2(1 - c_1^2)"
    AMPLITUDE_S = r"r_s = \frac{n_1 c_1 - n_2 c_2}{n_1 c_1 + n_2 c_2}"
    AMPLITUDE_P = r"r_p = \frac{n_2 c_1 - n_1 c_2}{n_2 c_1 + n_1 c_2}"
    REFLECTANCE = r"R"
    TRANSMITTED = r"T = 1 - R"
    SHARE_R = r"(k_r + k_t) R"
    SHARE_T = r"(k_r + k_t) T"

    INCOMING = r"\mathbf{v}"
    NORMAL = r"\mathbf{n}"
    REFLECTED = r"\mathbf{r}"
    REFRACTED = r"\mathbf{t}"
    SCALED = r"n\,\mathbf{v}"
    STRAIGHT = r"\mathbf{t} = \mathbf{v}"
    COSINE = r"\mathbf{n}\cdot\mathbf{v}"
    THETA_1 = r"\theta_1"
    THETA_2 = r"\theta_2"
    THETA_C = r"\theta_c"
    INDEX_1 = r"n_1"
    INDEX_2 = r"n_2"
    TOO_LARGE_SINE = r"\sin\theta_2"
    INDICES = r"n_1 \to n_2"
    ANGLES = r"\theta_1 \to \theta_2"

    COLOR = r"C"
    COEFFICIENTS = r"k_a \quad k_d \quad k_s \quad p"
    LIGHT = r"L"
    TO_LIGHT = r"\mathbf{N}\cdot\mathbf{L}"
    FACES_AWAY = r"\mathbf{N}\cdot\mathbf{L} \leq 0"
    DIFFUSE = r"k_d C (\mathbf{N}\cdot\mathbf{L})"
    MIRRORED = r"\mathbf{R}\cdot\mathbf{V}"
    EXPONENT = r"p"
    HIGHLIGHT = r"k_s (\mathbf{R}\cdot\mathbf{V})^p"

    QUADRATIC = r"a t^2 + b t + c = 0"
    QUADRATIC_A = r"a = \mathbf{d}\cdot\mathbf{d}"
    QUADRATIC_B = r"b = 2 \mathbf{d}\cdot(\mathbf{o} - \mathbf{m})"
    QUADRATIC_C = r"c = |\mathbf{o} - \mathbf{m}|^2 - r^2"
    DISCRIMINANT = r"D = b^2 - 4 a c"
    ROOTS = r"t = \frac{-b \pm \sqrt{D}}{2 a}"
    ROOT_1 = r"t_1"
    ROOT_2 = r"t_2"
    BARYCENTRIC = r"\mathbf{p} = \alpha \mathbf{a} + \beta \mathbf{b} + \gamma \mathbf{c}"
    ALPHA = r"\alpha"
    BETA = r"\beta"
    GAMMA = r"\gamma"
    BARYCENTRIC_SUM = r"\alpha + \beta + \gamma"
    PHONG_REFLECTION = r"\mathbf{R} = 2 (\mathbf{N}\cdot\mathbf{L})\,\mathbf{N} - \mathbf{L}"
    PHONG_MIRRORED = r"\mathbf{R}"
    PHONG_NORMAL = r"\mathbf{N}"
    PHONG_LIGHT = r"\mathbf{L}"
    PHONG_VIEW = r"\mathbf{V}"
    CROSSINGS = r"\mathrm{crossings} = 2 k + 1"
