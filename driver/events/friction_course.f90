!> The friction of a block within a step in which its normal traction changes: over that it may be
!> largest or least between the ends.
!>
!> A surface that slides carries its strength, or, while slip comes gradually, a share of it, and
!> what it remembers changes little in a step: share and friction coefficient are linear between the
!> ends. What sticks follows its spring, by cubic interpolation, up to its strength.
module friction_course
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : facts => law_facts
    use law_facts, only : strength_at
    use loading_programme, only : programme
    use slip_events, only : cubic
    implicit none
    private

    public :: course

    type :: course
        real(dp) :: start = 0.0_dp, length = 0.0_dp   !! of the step [T]
        logical :: slides = .false.
        logical :: yields = .true.            !! what sticks carries no more than its strength
        real(dp) :: force(2) = 0.0_dp         !! of friction over the area, at the ends [F/L^2]
        real(dp) :: rate(2) = 0.0_dp          !! likewise, of a surface that sticks [F/L^2/T]
        real(dp) :: coefficient(2) = 0.0_dp   !! of friction [-]
        type(facts) :: law
        real(dp) :: load(2) = 0.0_dp          !! normal tractions [F/L^2]
        real(dp) :: load_rate(2) = 0.0_dp     !! [F/L^2/T]
        logical :: prescribed = .true.        !! the programme tells the normal traction between
    contains
        procedure :: extremes
        procedure, private :: friction_at
    end type course

contains

    !> Widens a range by the least and the largest friction over normal traction between the ends,
    !> where that is more than a threshold.
    pure subroutine extremes(self, drive, piece, threshold, range)
        class(course), intent(in) :: self
        type(programme), intent(in) :: drive
        integer, intent(in) :: piece
        real(dp), intent(in) :: threshold     !! [F/L^2]
        real(dp), intent(inout) :: range(2)   !! least, largest [-]
        integer, parameter :: parts = 8
        real(dp) :: values(0:parts), spread
        logical :: told(0:parts)
        integer :: i

        do i = 0, parts
            call self%friction_at(real(i, dp) / parts, drive, piece, threshold, values(i), told(i))
        end do
        if (.not. any(told)) return
        spread = maxval(values, told) - minval(values, told)
        i = minloc(values, 1, told) - 1
        if (values(i) - spread < range(1) .or. .not. all(told)) call closer(-1.0_dp, range(1))
        i = maxloc(values, 1, told) - 1
        if (values(i) + spread > range(2) .or. .not. all(told)) call closer(1.0_dp, range(2))

    contains

        !> Goes from the best of the parts to the best about it, by half the way at each turn.
        pure subroutine closer(sense, best)
            real(dp), intent(in) :: sense      !! 1: the largest, -1: the least
            real(dp), intent(inout) :: best    !! of all steps
            integer, parameter :: turns = 25
            real(dp) :: middle, way, top, value, share
            logical :: is_told
            integer :: k, side

            middle = real(i, dp) / parts
            top = values(i)
            way = 0.5_dp / parts
            do k = 1, turns
                do side = -1, 1, 2
                    share = min(1.0_dp, max(0.0_dp, middle + side * way))
                    call self%friction_at(share, drive, piece, threshold, value, is_told)
                    if (is_told .and. sense * value > sense * top) exit
                end do
                if (side > 1) then
                    way = 0.5_dp * way
                else
                    top = value
                    middle = share
                end if
            end do
            if (sense * top > sense * best) best = top
        end subroutine closer

    end subroutine extremes

    !> Friction over normal traction at a part of the step.
    pure subroutine friction_at(self, share, drive, piece, threshold, friction, told)
        class(course), intent(in) :: self
        real(dp), intent(in) :: share       !! of the step, 0 to 1
        type(programme), intent(in) :: drive
        integer, intent(in) :: piece
        real(dp), intent(in) :: threshold   !! [F/L^2]
        real(dp), intent(out) :: friction   !! [-]
        logical, intent(out) :: told        !! the normal traction is more than the threshold
        real(dp) :: load, force, strengths(2), shares(2)

        load = cubic(self%load, self%length * self%load_rate, share)
        if (self%prescribed) load = drive%normal_traction(self%start + share * self%length, piece)
        friction = 0.0_dp
        told = load > threshold
        if (.not. told) return
        if (self%slides) then
            strengths = strength_at(self%law, self%coefficient, self%load)
            shares = 0.0_dp
            where (strengths > 0.0_dp) shares = max(-1.0_dp, min(1.0_dp, self%force / strengths))
            force = linear(shares) * strength_at(self%law, linear(self%coefficient), load)
        else
            force = cubic(self%force, self%length * self%rate, share)
            if (self%yields) force = sign(min(abs(force), strength_at(self%law, &
                maxval(self%coefficient), load)), force)
        end if
        friction = force / load

    contains

        pure real(dp) function linear(ends) result(value)
            real(dp), intent(in) :: ends(2)

            value = (1.0_dp - share) * ends(1) + share * ends(2)
        end function linear

    end subroutine friction_at

end module friction_course
