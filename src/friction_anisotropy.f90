!> Friction with two coefficients, along two axes of the interface (docs/theory.md, section 9).
!>
!> Surfaces of equal strength are ellipses: with `squeeze` = mu_1/mu_2, the laws see the
!> equivalent traction
!>
!>     T_eq = sqrt(T_1^2 + (squeeze T_2)^2) = resistance
!>
!> and the slip's Euclidean length. The surface slides along the normal of the ellipse through the
!> traction at the end of the increment (`slide_associated`) or, by option, along the trial traction
!> as an isotropic one does (module `friction_contact`).
module friction_anisotropy
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, sliding
    use friction_law_constants, only : complete_constants, law_constant
    use friction_return_map, only : return_along, unloaded, unloading
    use friction_status, only : friction_ok
    implicit none
    private

    public :: associated_spring, associated_way, ellipse_spring, isotropic, orthotropy, &
        read_orthotropy, slide_associated, sliding_way, tangential_trial

    real(wp), parameter, public :: largest_mu_ratio = 1.0e3_wp   !! of the two coefficients [-]

    !> Direction in which an orthotropic surface slides: values of the constant `direction`.
    integer, parameter, public :: direction_associated = 0   !! normal to the surface of strength
    integer, parameter, public :: direction_radial = 1       !! along the trial traction

    !> The constants that every law takes after its shear cap.
    type(law_constant), parameter, public :: orthotropy_constants(2) = [ &
        law_constant('mu_ratio', '-', 'friction coefficient along axis 2 over that along axis 1', &
        'FrictionRatio', &
        lower=1.0_wp / largest_mu_ratio, upper=largest_mu_ratio, or_zero=.true., optional=.true., &
        default=1.0_wp), &
        law_constant('direction', '-', 'direction of slip', 'SlipDirection', &
        lower=0.0_wp, upper=1.0_wp, &
        optional=.true., whole=.true., words='associated radial')]

    !> How friction depends on the direction.
    type :: orthotropy
        real(wp) :: squeeze      !! mu_1/mu_2: traction along axis 2 counts that much more [-]
        logical :: associated    !! squeeze /= 1, and the surface slides normal to its ellipse
    end type orthotropy

    type(orthotropy), parameter :: isotropic = orthotropy(squeeze=1.0_wp, associated=.false.)

    !> A closed contact whose slip is prevented.
    type :: tangential_trial
        real(wp) :: q(2)           !! elastic tangential displacement [L]
        real(wp) :: distance       !! its equivalent length [L]
        real(wp) :: stiffness      !! alpha_t, with a damper beside the spring that of both [F/L^3]
        real(wp) :: pressure       !! > 0, or with cohesion 0 [F/L^2]
        real(wp) :: dt             !! increment of time [T]
        type(law_state) :: start   !! internal variables at the start of sliding
    end type tangential_trial

    !> How the traction of a sliding surface answers a change of the trial displacement q.
    type :: sliding_way
        real(wp) :: tau(2)       !! traction [F/L^2]
        real(wp) :: along(2)     !! unit vector of the slip [-]
        real(wp) :: response(2)  !! change of the traction when it grows; along . response = 1 [-]
        real(wp) :: across       !! stiffness against q at right angles to the slip [F/L^3]
        real(wp) :: cross_stiffness   !! fall of T_eq with such q, where the slip is fixed [F/L^3]
        real(wp) :: stiffness    !! fall of T_eq with slip, where q is fixed [F/L^3]
        real(wp) :: work_ratio   !! work of the traction over slip and T_eq [-]
    end type sliding_way

    !> The spring of an associated surface. Each component of the traction relaxes at a rate of its
    !> own,
    !>
    !>     T_i = alpha_t q_i (1 - x) e_i,   e_i = 1/(1 + (r_i - 1) x),   slip_i = q_i r_i x e_i
    !>
    !> where r_i >= 1 is that rate, over the slower one's. T_eq is convex in the slip.
    type, extends(unloading) :: ellipse_spring
        real(wp) :: q(2)         !! trial elastic displacement [L]
        real(wp) :: squeeze      !! [-]
        real(wp) :: rates(2)     !! r_i [-]
    contains
        procedure :: at => on_an_ellipse
    end type ellipse_spring

    !> Where that spring is at some x.
    type :: relaxation
        real(wp) :: e(2)         !! e_i [-]
        real(wp) :: q(2)         !! e_i q_i, along the traction [L]
        real(wp) :: equivalent   !! its equivalent length [L]
        real(wp) :: along(2)     !! unit vector of the slip [-]
        real(wp) :: length       !! slip/x [L]
        real(wp) :: reach        !! length of the ellipse's gradient, -dT_eq/d(slip)/alpha_t [-]
        real(wp) :: mean         !! of e_i, weighted by the squares of `along` [-]
    end type relaxation

contains

    !> From the constants `mu_ratio` and `direction`.
    pure subroutine read_orthotropy(n, constants, plane, status)
        integer, intent(in) :: n                   !! how many are given; none: isotropic
        real(wp), intent(in) :: constants(n)       !! finite
        type(orthotropy), intent(out) :: plane     !! if the status is ok
        integer, intent(out) :: status             !! ok or bad property
        real(wp) :: c(size(orthotropy_constants))

        call complete_constants(0, orthotropy_constants, n, constants, c, status)
        if (status /= friction_ok) return
        plane = isotropic
        if (.not. c(1) > 0.0_wp) return
        plane%squeeze = 1.0_wp / c(1)
        plane%associated = abs(c(1) - 1.0_wp) > 0.0_wp .and. int(c(2)) == direction_associated
    end subroutine read_orthotropy

    !> Along the normal of the ellipse through the traction at the end.
    pure subroutine slide_associated(surface, squeeze, trial, slid, way, status)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: squeeze         !! [-]
        type(tangential_trial), intent(in) :: trial
        type(sliding), intent(out) :: slid
        type(sliding_way), intent(out) :: way
        integer, intent(out) :: status          !! ok, snap back, or no convergence
        type(ellipse_spring) :: spring
        real(wp) :: x

        spring = associated_spring(trial%stiffness, squeeze, trial%q, trial%distance)
        call return_along(surface, spring, trial%pressure, trial%dt, trial%start, slid, x, status)
        if (status >= 0) way = associated_way(spring, x, slid%resistance)
    end subroutine slide_associated

    !> The spring of a surface that slides normal to its ellipse.
    pure function associated_spring(alpha_t, squeeze, q, distance) result(spring)
        real(wp), intent(in) :: alpha_t         !! tangential stiffness [F/L^3]
        real(wp), intent(in) :: squeeze         !! [-]
        real(wp), intent(in) :: q(2)            !! trial elastic displacement [L]
        real(wp), intent(in) :: distance        !! its equivalent length [L]
        type(ellipse_spring) :: spring

        spring%trial = alpha_t * distance
        spring%x_end = 1.0_wp
        spring%stiffness = alpha_t
        spring%q = q
        spring%squeeze = squeeze
        spring%rates(1) = max(1.0_wp, 1.0_wp / squeeze**2)
        spring%rates(2) = max(squeeze**2, 1.0_wp)
    end function associated_spring

    !> Where it slides at x. The law's traction is exact, the spring's a difference.
    pure function associated_way(spring, x, resistance) result(way)
        type(ellipse_spring), intent(in) :: spring
        real(wp), intent(in) :: x            !! 0 to 1 [-]
        real(wp), intent(in) :: resistance   !! of the law there [F/L^2]
        type(sliding_way) :: way
        type(relaxation) :: now

        now = relaxed(spring, x)
        way%tau = (resistance / now%equivalent) * now%q
        way%along = now%along
        way%response = now%e * now%along / now%mean
        way%across = (resistance / now%equivalent) * now%e(1) * now%e(2) / now%mean
        way%cross_stiffness = 0.0_wp
        way%stiffness = spring%stiffness * now%reach
        way%work_ratio = 1.0_wp / now%reach
    end function associated_way

    pure subroutine on_an_ellipse(self, x, there)
        class(ellipse_spring), intent(in) :: self
        real(wp), intent(in) :: x   !! 0 to 1 [-]
        type(unloaded), intent(out) :: there
        type(relaxation) :: now

        now = relaxed(self, x)
        there%slip = x * now%length
        there%traction = self%stiffness * (1.0_wp - x) * now%equivalent
        there%stiffness = self%stiffness * now%reach
        there%rate = now%length * now%mean
        there%scale = there%traction
    end subroutine on_an_ellipse

    !> The spring at x, but for the factors x and 1 - x: nothing here vanishes at either end.
    pure function relaxed(spring, x) result(now)
        class(ellipse_spring), intent(in) :: spring
        real(wp), intent(in) :: x   !! 0 to 1 [-]
        type(relaxation) :: now
        real(wp) :: slip(2)

        now%e = 1.0_wp / (1.0_wp + (spring%rates - 1.0_wp) * x)
        now%q = now%e * spring%q
        now%equivalent = hypot(now%q(1), spring%squeeze * now%q(2))
        slip = spring%rates * now%q
        now%length = hypot(slip(1), slip(2))
        now%along = slip / now%length
        now%reach = now%length / (spring%rates(1) * now%equivalent)
        now%mean = now%e(1) * now%along(1)**2 + now%e(2) * now%along(2)**2
    end function relaxed

end module friction_anisotropy
