!> Random paths of contact points: constants of every law and option over decades, states that a
!> user may set, increments of every kind.
module path_draws
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use draws, only : draw
    use independent_laws, only : creeps
    implicit none
    private

    public :: decade, draw_increment, draw_props, draw_state, draw_time, path, points

    !> Points that share constants and increments of time, as a batch does.
    integer, parameter :: points = 16

    type :: path
        real(dp), allocatable :: props(:)
        logical :: needs_time        !! the law or its damper does
        logical :: damped            !! it has a damper
        logical :: cohesive          !! it carries something without pressure
        logical :: extreme           !! over the whole range of the arithmetic
        real(dp) :: half             !! decades to either side that quantities span
        real(dp) :: pressure, reach, time   !! typical: pressure, elastic displacement, increment
        real(dp) :: statev(points, 8), du(points, 3), dt
    end type path

contains

    function decade(half) result(x)
        real(dp), intent(in) :: half
        real(dp) :: x

        x = 10.0_dp**draw(-half, half)
    end function decade

    logical function chance(p)
        real(dp), intent(in) :: p

        chance = draw(0.0_dp, 1.0_dp) < p
    end function chance

    !> A law with its options, and points under it that nothing has touched.
    subroutine draw_props(this)
        type(path), intent(out) :: this
        real(dp) :: own(14), half, mu
        integer :: law, n

        this%extreme = chance(0.05_dp)
        this%half = 0.5_dp * nint(draw(0.5_dp, 7.5_dp))
        half = this%half
        law = min(8, 1 + int(draw(0.0_dp, 16.0_dp)) / 2 + int(draw(0.0_dp, 1.3_dp)))
        mu = draw(0.05_dp, 1.5_dp)
        this%pressure = 10.0_dp * decade(half)
        own = 0.0_dp
        own(1) = mu
        own(2) = mu * draw(0.0_dp, 1.0_dp)
        if (chance(0.1_dp)) own(2) = merge(0.0_dp, mu, chance(0.5_dp))
        allocate (this%props(3))
        this%props = [real(law, dp), 1.0e3_dp * decade(half), 1.0e3_dp * decade(half)]
        this%reach = mu * this%pressure / this%props(3)
        this%time = 1.0e-3_dp * decade(half)
        select case (law)
        case (1)
            call draw_subloading(this, own)
            n = 8
        case (2)
            n = 1
        case (3)
            own(3) = this%time / this%reach * decade(half)
            n = 3
        case (4, 8)
            own(1:2) = mu * [0.02_dp, 0.03_dp] * [decade(0.3_dp * half), decade(0.3_dp * half)]
            own(3) = this%reach * decade(half)
            own(4) = own(3) / this%time * decade(half)
            own(5) = mu
            own(6) = merge(0.0_dp, 1.0_dp, chance(0.5_dp))
            own(7) = own(3) / own(4) * decade(half)
            n = 7
            if (law == 8) then
                own(7:8) = own(6:7)
                own(6) = mu * draw(0.0_dp, 1.0_dp) * decade(0.3_dp * half)
                if (chance(0.1_dp)) own(6) = 0.0_dp
                n = 8
            end if
        case (7)
            call draw_flash_heating(this, mu, own)
            n = 9
        case default
            own(3) = this%reach * decade(half)
            own(4) = decade(half) / this%time
            if (chance(0.1_dp)) own(4) = 0.0_dp
            n = merge(3, 4, law == 5)
        end select
        this%needs_time = any(law == [3, 4, 7, 8])
        call draw_options(this, own, n)
        this%props = [this%props, own(:n)]
        this%needs_time = this%needs_time .or. this%damped
        if (this%extreme) call make_extreme(this)
        this%statev = 0.0_dp
        this%du = 0.0_dp
    end subroutine draw_props

    subroutine draw_subloading(this, own)
        type(path), intent(in) :: this
        real(dp), intent(inout) :: own(14)
        integer :: form

        own(3) = decade(this%half) / this%reach
        own(4) = decade(this%half) / this%time
        own(5) = 10.0_dp * decade(this%half) / this%reach
        if (chance(0.1_dp)) own(3) = 0.0_dp
        if (chance(0.1_dp)) own(4) = 0.0_dp
        own(6) = draw(own(2), own(1))
        form = int(draw(0.0_dp, 6.0_dp))
        if (form == 0 .or. form == 1) own(7) = 1.0_dp
        if (form == 2) own(8) = 1.0_dp
        if (form == 3) own(8) = 2.0_dp
    end subroutine draw_subloading

    subroutine draw_flash_heating(this, mu, own)
        type(path), intent(in) :: this
        real(dp), intent(in) :: mu
        real(dp), intent(inout) :: own(14)

        own(1) = 0.02_dp * mu * decade(0.3_dp * this%half)
        own(2) = 0.03_dp * mu * decade(0.3_dp * this%half)
        own(3) = this%reach * decade(this%half)
        own(4) = own(3) / this%time * decade(this%half)
        own(5) = mu
        own(6) = mu * draw(0.0_dp, 1.0_dp)
        if (chance(0.1_dp)) own(6) = merge(0.0_dp, mu, chance(0.5_dp))
        own(7) = this%reach / this%time * decade(this%half)
        own(8) = draw(1.0_dp, 12.0_dp)
        if (chance(0.3_dp)) own(8) = merge(1.0_dp, 8.0_dp, chance(0.5_dp))
        own(9) = own(3) / own(4) * decade(this%half)
    end subroutine draw_flash_heating

    !> Shear cap, on either side of the strength or just at it, orthotropy, cohesion and damper.
    subroutine draw_options(this, own, n)
        type(path), intent(inout) :: this
        real(dp), intent(inout) :: own(14)
        integer, intent(inout) :: n

        this%damped = .false.
        this%cohesive = .false.
        if (chance(0.4_dp)) return
        n = n + 1
        if (chance(0.6_dp)) own(n) = own(1) * this%pressure * decade(0.5_dp)
        if (chance(0.05_dp)) own(n) = own(1) * this%pressure
        if (chance(0.5_dp)) return
        own(n + 1) = 10.0_dp**draw(-1.0_dp, 1.0_dp)
        if (chance(0.2_dp)) own(n + 1) = 10.0_dp**draw(-3.0_dp, 3.0_dp)
        own(n + 2) = merge(0.0_dp, 1.0_dp, chance(0.6_dp))
        if (chance(0.5_dp)) own(n + 1) = 0.0_dp
        n = n + 2
        if (chance(0.3_dp)) return
        this%cohesive = chance(0.6_dp)
        if (this%cohesive) own(n + 1) = this%props(3) * this%reach * decade(this%half)
        this%damped = chance(0.5_dp)
        if (this%damped) own(n + 2) = this%props(3) * this%time * decade(this%half)
        n = n + 2
    end subroutine draw_options

    !> Anything that the range of the arithmetic holds.
    subroutine make_extreme(this)
        type(path), intent(inout) :: this
        real(dp) :: big
        integer :: i

        big = draw(5.0_dp, 99.0_dp)
        do i = 2, min(size(this%props), 9)
            if (nint(this%props(1)) == 4 .and. i == 9) cycle
            if (nint(this%props(1)) == 8 .and. i == 10) cycle
            if (this%props(i) > 0.0_dp .and. chance(0.7_dp)) this%props(i) = decade(big)
        end do
        if (all(nint(this%props(1)) /= [2, 4, 7, 8])) this%props(5) = &
            min(this%props(5), this%props(4))
        if (nint(this%props(1)) == 7) this%props(9) = min(this%props(9), this%props(8))
        if (nint(this%props(1)) == 1) this%props(9) = this%props(4)
        this%half = big
        this%pressure = decade(big)
        this%reach = decade(big)
        this%time = decade(big)
    end subroutine make_extreme

    subroutine draw_time(this)
        type(path), intent(inout) :: this

        this%dt = this%time * decade(0.5_dp * this%half)
        if (chance(0.1_dp)) this%dt = 0.0_dp
        if (chance(0.03_dp)) this%dt = this%time * decade(12.0_dp)
    end subroutine draw_time

    !> The next increment of point i: of one of many kinds.
    subroutine draw_increment(this, i)
        type(path), intent(inout) :: this
        integer, intent(in) :: i
        real(dp) :: old(3), u(3), angle, size_, depth

        old = this%du(i, :)
        u = this%statev(i, 2:4)
        depth = this%pressure / this%props(2)
        angle = draw(0.0_dp, 6.3_dp)
        if (chance(0.5_dp) .and. any(abs(u(2:3)) > 0.0_dp)) angle = atan2(u(3), u(2)) &
            + draw(-0.5_dp, 0.5_dp) * decade(2.0_dp)
        size_ = this%reach * decade(min(this%half, 2.0_dp))
        this%du(i, 1) = draw(-0.3_dp, 0.3_dp) * depth
        if (.not. u(1) < 0.0_dp) this%du(i, 1) = -u(1) - depth * draw(0.1_dp, 1.0_dp)
        select case (int(draw(0.0_dp, 24.0_dp)))
        case (0)
            this%du(i, :) = 0.0_dp
            return
        case (1)
            size_ = this%reach * 10.0_dp**draw(-25.0_dp, -8.0_dp)
        case (2)   ! a reversal, whole or in part, or through zero
            this%du(i, :) = [0.0_dp, -old(2:3)]
            if (chance(0.3_dp)) this%du(i, 2:3) = -u(2:3)
            if (chance(0.3_dp)) this%du(i, 2:3) = -u(2:3) * draw(0.5_dp, 3.0_dp)
            return
        case (3)   ! opens
            this%du(i, 1) = abs(u(1)) * draw(0.9_dp, 2.0_dp) + depth * draw(0.0_dp, 0.1_dp)
        case (4)
            size_ = 0.0_dp
        case (5, 6)
            this%du(i, 1) = 0.0_dp
        case (7)
            this%du(i, 1) = this%du(i, 1) * 10.0_dp**draw(-200.0_dp, 0.0_dp)
        case (8)
            size_ = size_ * decade(min(2.0_dp * this%half, 6.0_dp))
        case (9)   ! just touches
            if (this%cohesive) this%du(i, 1) = -u(1)
        case default
        end select
        this%du(i, 2:3) = size_ * [cos(angle), sin(angle)]
        if (chance(0.2_dp)) this%du(i, 3) = 0.0_dp
    end subroutine draw_increment

    !> A state that the user guide lets a user set: what it says of the traction need not agree with
    !> R.
    subroutine draw_state(this, i)
        type(path), intent(inout) :: this
        integer, intent(in) :: i   !! point
        real(dp), parameter :: corners(6) = [0.0_dp, 1.0_dp, 1.0_dp - epsilon(1.0_dp), 1.0_dp &
            - 1.0e-9_dp, 1.0e-12_dp, 1.0e-200_dp]
        real(dp) :: r, angle, reach, mu

        if (chance(0.3_dp)) then
            this%statev(i, :) = 0.0_dp
            return
        end if
        r = draw(0.0_dp, 1.0_dp)
        if (chance(0.4_dp)) r = corners(1 + int(draw(0.0_dp, 5.99_dp)))
        mu = this%props(4)
        if (nint(this%props(1)) == 1) mu = draw(this%props(5), this%props(4))
        if (creeps(nint(this%props(1)))) mu = 0.5_dp
        angle = draw(0.0_dp, 6.3_dp)
        reach = r * mu * this%pressure / this%props(3)
        if (chance(0.2_dp)) reach = reach * draw(0.0_dp, 2.0_dp)
        this%statev(i, :) = [1.0_dp, -this%pressure / this%props(2), reach * cos(angle), &
            reach * sin(angle), mu, 0.0_dp, 0.0_dp, 0.0_dp]
        if (chance(0.5_dp)) this%statev(i, 3:4) = [reach, 0.0_dp]
        if (nint(this%props(1)) == 1) this%statev(i, 6) = r
        if (creeps(nint(this%props(1)))) this%statev(i, 6) = min(1.0e100_dp, this%props(6) &
            / this%props(7) * decade(min(this%half, 20.0_dp)))
        if (any(nint(this%props(1)) == [5, 6])) then
            this%statev(i, 6) = r * this%props(6)
            if (chance(0.2_dp)) this%statev(i, 6) = this%props(6) * draw(0.9_dp, 3.0_dp)
        end if
        if (any(abs(this%statev(i, :)) > 1.0e100_dp)) this%statev(i, :) = 0.0_dp
        if (this%statev(i, 1) > 0.0_dp .and. chance(0.05_dp)) then
            this%statev(i, 7:8) = 1.0e100_dp * draw(0.1_dp, 1.7_dp)
        end if
    end subroutine draw_state

end module path_draws
