!> What the vector lanes of all laws share: blocks of contact points, component by component.
!>
!> The modules of this folder are compiled once for each vector instruction set, under other names,
!> together with the laws' cores (src/CMakeLists.txt): they use nothing else, so that the copies
!> share nothing. No floating-point exception but inexact and underflow: a lane that a formula is
!> not
!> meant for gets numbers that harm nobody.
module friction_lane_block
    use, intrinsic :: iso_c_binding, only : c_double, c_int, c_int64_t
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    public :: below_largest, zero_unless

    integer, parameter, public :: lanes = 64   !! points of a block: its scratch data stay in the
                                               !! first-level cache
    integer, parameter, public :: widest = 8   !! lanes of the widest vectors
    !> From one component to the next in a block that was transposed: a power of two would crowd
    !> into few lines of the cache.
    integer, parameter, public :: apart = lanes + 8

    !> Columns of the constants of a block's points.
    integer, parameter, public :: c_alpha_n = 1   !! [F/L^3]
    integer, parameter, public :: c_alpha_t = 2   !! [F/L^3]
    integer, parameter, public :: c_mu_0 = 3      !! friction coefficient of a virgin point [-]
    integer, parameter, public :: c_r_0 = 4       !! its internal variable
    integer, parameter, public :: c_cap = 5       !! shear cap; without one `no_cap` [F/L^2]
    integer, parameter, public :: c_squeeze = 6   !! mu_1/mu_2 of orthotropic friction [-]
    integer, parameter, public :: c_own = 7       !! first of the law's own, in the order of `props`
    integer, parameter, public :: n_own = 10      !! at most; choices between words are not counted
    integer, parameter, public :: n_constants = c_own + n_own - 1
    real(wp), parameter, public :: no_cap = 1.0e90_wp
    real(wp), parameter, public :: least_ratio = 1.0e-100_wp   !! of module friction_law
    real(wp), parameter, public :: verge = 32.0_wp * epsilon(verge)   !! of module friction_contact
    !> Lanes round in another way than the routine for one point: a point whose numbers are this
    !> near to a choice, as a share of them, is left to that.
    real(wp), parameter, public :: unsure = 0.25_wp * verge

    !> Laws with lanes. Those that share lanes follow each other (module friction_law_lanes), and
    !> those of the subloading surface come first.
    integer, parameter, public :: lane_none = 0, lane_subloading = 1, lane_exact_rate = 2, &
        lane_cotangent = 3, lane_reciprocal = 4, lane_coulomb = 5, lane_static_kinetic = 6, &
        lane_slip_weakening = 7, lane_healing = 8, lane_ageing = 9, lane_slip_law = 10, &
        lane_pressed_ageing = 11, lane_pressed_slip_law = 12, lane_flash_heating = 13

    !> Options of laws.
    integer(c_int), parameter, public :: with_cap = 1, with_two_coefficients = 2

    !> What a call of the batch kernel is about.
    type, bind(C), public :: block_task
        integer(c_int64_t) :: stride   !! distance of components, `lanes` or more
        integer(c_int) :: kind         !! law
        integer(c_int) :: ndir         !! components of du: 2 or 3
        integer(c_int) :: n_own        !! constants of the law's own, of each point; 0 where all
                                       !! points share them
        integer(c_int) :: options      !! sum of those that a point of the block has
        real(c_double) :: dt           !! [T]
        real(c_double) :: cohesion     !! of all points [F/L^2]
        real(c_double) :: viscous      !! stiffness of the damper of all points, eta_t/dt [F/L^3]
    end type block_task

    !> Where points find their own constants, and the rules of these.
    type, bind(C), public :: constants_source
        integer(c_int) :: n_own = 0                !! columns of the law's own constants
        integer(c_int) :: place(n_constants) = 0   !! in `props`; 0: none, `value` instead
        integer(c_int) :: not_below(n_constants) = 0, not_above(n_constants) = 0   !! columns, or 0
        real(c_double) :: value(n_constants) = 0.0_c_double
        real(c_double) :: lower(n_constants) = 0.0_c_double   !! least value
        real(c_double) :: upper(n_constants) = huge(1.0_c_double)   !! largest value
        integer(c_int) :: n_choices = 0          !! constants that have to be what they are here,
                                                 !! one at least
        integer(c_int) :: choice(6) = 0          !! their places in `props`; the last one fills
                                                 !! what is left
        real(c_double) :: chosen(6) = 0.0_c_double   !! and values
    end type constants_source

    !> An increment without slip.
    type, public :: rest_block
        real(wp) :: traction(lanes)    !! in: carried elastically, 0 in an open contact [F/L^2]
        real(wp) :: pressure(lanes)    !! in: 0 in an open contact [F/L^2]
        real(wp) :: before(lanes)      !! in, for laws that count it: the same at the start of the
                                       !! increment [F/L^2]
        real(wp) :: mu(lanes), r(lanes)   !! in: at the start of the increment
        real(wp) :: mu_rest(lanes), r_rest(lanes)   !! out: at its end, if nothing slips
        real(wp) :: strength(lanes)    !! out: traction at which slip starts [F/L^2]
        real(wp) :: valid(lanes)       !! out: below 0 where the state is out of its range
    end type rest_block

    !> Points that slide.
    type, public :: slide_block
        real(wp) :: trial(lanes)       !! in: tangential traction without slip [F/L^2]
        real(wp) :: stiffness(lanes)   !! in: tangential stiffness [F/L^3]
        real(wp) :: pressure(lanes)    !! in: > 0 [F/L^2]
        real(wp) :: before(lanes)      !! in, for laws that count it: the same at the start of the
                                       !! increment [F/L^2]
        real(wp) :: mu(lanes), r(lanes)   !! in: at the start of the increment
        real(wp) :: mu_rest(lanes)     !! in: at its end, if nothing slips
        real(wp) :: slip(lanes)        !! out [L]
        real(wp) :: mu_end(lanes), r_end(lanes)   !! out: at the end of the increment
        real(wp) :: resistance(lanes)  !! out [F/L^2]
        real(wp) :: d_slip(lanes)      !! out: d(resistance)/d(slip) [F/L^3]
        real(wp) :: d_pressure(lanes)  !! out: d(resistance)/d(pressure) [-]
        real(wp) :: left(lanes)        !! out: above 0 where the routine for one point is needed:
                                       !! several equilibria are possible, or none was found
        integer :: n                   !! how many, a multiple of the widest vector; behind the
                                       !! arrays, which begin where vectors do
    end type slide_block

contains

    !> All bits set if a sum of magnitudes is finite and below a limit, else none. Read as integers:
    !> silent where a comparison with NaN raises an exception.
    elemental function below_largest(total, largest) result(mask)
        real(wp), intent(in) :: total, largest
        integer(c_int64_t) :: mask

        mask = shifta(transfer(total, mask) - transfer(largest, mask), 63)
    end function below_largest

    elemental function zero_unless(mask, x) result(kept)
        integer(c_int64_t), intent(in) :: mask   !! all bits or none
        real(wp), intent(in) :: x
        real(wp) :: kept

        kept = transfer(iand(transfer(x, mask), mask), x)
    end function zero_unless

end module friction_lane_block
