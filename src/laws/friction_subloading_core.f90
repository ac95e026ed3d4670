!> The arithmetic of the subloading law on plain numbers, backward Euler (docs/theory.md, section
!> 3):
!> what both the update of one point and the vector lanes of a batch are made of.
!>
!> A core uses nothing but the kind of its numbers: the build puts a copy of it into each copy of a
!> kernel (src/CMakeLists.txt). Its elemental procedures are inlined into loops that become vector
!> instructions.
module friction_subloading_core
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    public :: reserve, coefficient, fall_of_coefficient, start_far, chebyshev, settled, moved, &
        slope, logarithm_after, ratio_step

    !> One point that slides.
    type, public :: slip_task
        real(wp) :: trial       !! tangential traction without slip [F/L^2]
        real(wp) :: stiffness   !! tangential stiffness [F/L^3]
        real(wp) :: pressure    !! [F/L^2]
        real(wp) :: r_n         !! R at the start of the increment [-]
        real(wp) :: c, w0       !! c and w(0) of section 3 [-]
        real(wp) :: mu_k, kappa, m   !! constants of the law
    end type slip_task

    !> Slip, R and 1 - R: near R = 1 the last is the number that carries the information.
    type, public :: slip_guess
        real(wp) :: s   !! [L]
        real(wp) :: r   !! [-]
        real(wp) :: e   !! [-]
    end type slip_guess

    !> Inverses at a guess, which lanes get by one division.
    type, public :: inverses
        real(wp) :: w      !! 1/w(s)
        real(wp) :: gain   !! 1/(R + m s)
        real(wp) :: r      !! 1/R
    end type inverses

    !> A step of the iteration.
    type, public :: slip_move
        real(wp) :: ds      !! [L]
        real(wp) :: dr      !! [-]
        real(wp) :: log_r   !! ln R before it
    end type slip_move

    !> The next error of a third-order iteration is the cube of a step this small.
    real(wp), parameter :: small_step = 1.0e-5_wp

contains

    !> The friction coefficient's share that slip can take away, times w: `c` of section 3.
    elemental function reserve(mu_n, mu_s, mu_k, healing) result(c)
        real(wp), intent(in) :: mu_n      !! coefficient at the start of the increment [-]
        real(wp), intent(in) :: mu_s, mu_k
        real(wp), intent(in) :: healing   !! xi dt [-]
        real(wp) :: c

        c = (mu_n - mu_k) + healing * (mu_s - mu_k)
    end function reserve

    !> mu after a slip, within its bounds in spite of round-off.
    elemental function coefficient(mu_s, mu_k, c, iw) result(mu)
        real(wp), intent(in) :: mu_s, mu_k, c
        real(wp), intent(in) :: iw   !! 1/w
        real(wp) :: mu

        mu = min(max(mu_k + c * iw, mu_k), mu_s)
    end function coefficient

    !> -d(mu)/ds, which is never negative and shrinks with the slip.
    elemental function fall_of_coefficient(kappa, c, iw) result(fall)
        real(wp), intent(in) :: kappa, c
        real(wp), intent(in) :: iw   !! 1/w
        real(wp) :: fall             !! [1/L]

        fall = (kappa * iw) * (c * iw)
    end function fall_of_coefficient

    !> A start for any slip: `-ln R ~ rate/m (1 - R)`, right at R_n, and `mu ~ mu(0)` make the
    !> equation a quadratic. Its positive root, taken where nothing cancels.
    elemental function start_far(task, full) result(guess)
        type(slip_task), intent(in) :: task
        real(wp), intent(in) :: full     !! traction of the normal sliding surface, mu p [F/L^2]
        type(slip_guess) :: guess
        real(wp) :: e_n, z, rate, excess, b, root, above, below, gain, shrink

        e_n = 1.0_wp - task%r_n
        z = 3.0_wp * (1.0_wp + task%r_n)**2 - 1.8_wp * e_n**2
        rate = (2.0_wp * task%m) * (z + e_n**2) / ((1.0_wp + task%r_n) * z)
        excess = task%trial - task%r_n * full
        b = 0.5_wp * (task%stiffness + rate * (e_n * full - excess))
        root = sqrt(b**2 + task%stiffness * rate * excess)
        above = root - b
        below = task%stiffness * rate
        if (b > 0.0_wp) then
            above = excess
            below = root + b
        end if
        gain = below + rate * above
        shrink = 1.0_wp / (gain * below)
        guess%s = above * gain * shrink
        guess%r = (task%r_n * below + rate * above) * below * shrink
        guess%e = e_n * below**2 * shrink
        if (guess%r < 0.5_wp) guess%e = 1.0_wp - guess%r
    end function start_far

    !> A step of Chebyshev's method, Newton's third-order kin, on the pair (s, R): Newton's step,
    !> and
    !> its correction by the second derivatives where that is one.
    elemental function chebyshev(task, at, ln_r, inverse) result(move)
        type(slip_task), intent(in) :: task
        type(slip_guess), intent(in) :: at
        real(wp), intent(in) :: ln_r   !! ln(at%r)
        type(inverses), intent(in) :: inverse
        type(slip_move) :: move
        real(wp) :: ms, slack, r_rate, misfit, mu, mu_rate, d, bend_s, bend_r

        ms = task%m * at%s
        slack = (1.0_wp - at%r) - at%e
        move%log_r = ln_r + slack
        r_rate = -task%m * move%log_r * at%r * inverse%gain
        misfit = ((at%r - task%r_n) + slack + ms * move%log_r) * at%r * inverse%gain
        mu = task%mu_k + task%c * inverse%w
        mu_rate = -task%kappa * task%c * inverse%w**2
        d = 1.0_wp / (task%stiffness + task%pressure * (at%r * mu_rate + mu * r_rate))
        move%ds = (task%trial - task%stiffness * at%s - task%pressure * mu * (at%r - misfit)) * d
        move%dr = r_rate * move%ds - misfit
        bend_r = inverse%gain * move%dr * (task%m * move%ds - 0.5_wp * ms * move%dr * inverse%r)
        bend_s = -task%pressure * (mu_rate * move%ds * (move%dr - task%kappa * inverse%w * at%r &
            * move%ds) - mu * bend_r) * d
        bend_r = r_rate * bend_s - bend_r
        if (max(abs(bend_s) - 0.5_wp * abs(move%ds), abs(bend_r) - 0.5_wp * abs(move%dr)) &
            > 0.0_wp) then
            bend_s = 0.0_wp
            bend_r = 0.0_wp
        end if
        move%ds = move%ds + bend_s
        move%dr = move%dr + bend_r
    end function chebyshev

    !> Above zero as long as another step is needed.
    elemental function settled(task, at, move) result(too_long)
        type(slip_task), intent(in) :: task
        type(slip_guess), intent(in) :: at
        type(slip_move), intent(in) :: move
        real(wp) :: too_long

        too_long = max(task%m * abs(move%ds) - small_step * (at%r + task%m * at%s), &
            task%kappa * abs(move%ds) - small_step * (task%w0 + task%kappa * at%s), &
            task%stiffness * abs(move%ds) - small_step * task%trial, &
            abs(move%dr) - small_step * min(at%r, at%e))
    end function settled

    !> The guess after a step, taken in whichever of R and 1 - R is the smaller number; none of the
    !> three loses its sign.
    elemental function moved(at, move) result(next)
        type(slip_guess), intent(in) :: at
        type(slip_move), intent(in) :: move
        type(slip_guess) :: next
        real(wp) :: r

        next%s = max(at%s + move%ds, 0.05_wp * at%s)
        r = max(at%r + move%dr, 0.05_wp * at%r)
        next%e = max(at%e - move%dr, 0.05_wp * at%e)
        next%r = 1.0_wp - next%e
        if (r < 0.5_wp) then
            next%r = r
            next%e = 1.0_wp - r
        end if
    end function moved

    !> ln R after a step too small to need another logarithm.
    elemental function logarithm_after(move, ir) result(log_r)
        type(slip_move), intent(in) :: move
        real(wp), intent(in) :: ir   !! 1/R before it
        real(wp) :: log_r
        real(wp) :: z

        z = move%dr * ir
        log_r = move%log_r + z * (1.0_wp - z * (0.5_wp - z * (1.0_wp / 3.0_wp)))
    end function logarithm_after

    !> d(resistance)/ds, with R = r and ln R = log_r.
    elemental function slope(task, r, log_r, inverse) result(d_slip)
        type(slip_task), intent(in) :: task
        real(wp), intent(in) :: r, log_r
        type(inverses), intent(in) :: inverse   !! 1/w and 1/(R + m s)
        real(wp) :: d_slip                      !! [F/L^3]

        d_slip = -task%pressure * r * ((task%mu_k + task%c * inverse%w) * task%m * log_r &
            * inverse%gain + task%kappa * task%c * inverse%w**2)
    end function slope

    !> A step of Newton's method to R after a given slip, from the left, where it climbs without
    !> fail
    !> because the equation is concave.
    elemental subroutine ratio_step(ms, r_n, log_r, at, dr)
        real(wp), intent(in) :: ms      !! m times the slip, >= 0 [-]
        real(wp), intent(in) :: r_n     !! R at the start of the increment [-]
        real(wp), intent(in) :: log_r   !! ln(at%r)
        type(slip_guess), intent(inout) :: at
        real(wp), intent(out) :: dr     !! the step
        real(wp) :: slack

        slack = (1.0_wp - at%r) - at%e
        dr = -at%r / (at%r + ms) * ((at%r - r_n) + slack + ms * (log_r + slack))
        at = moved(at, slip_move(0.0_wp, dr, 0.0_wp))
    end subroutine ratio_step

end module friction_subloading_core
