!> An increment that unloads a contact before it loads it again: where sliding starts, for laws that
!> follow the path within an increment (docs/theory.md, section 8).
module friction_reloading
    use friction_kinds, only : wp
    implicit none
    private

    public :: reloading, find_reloading

    !> The least share of the strength that the traction uses on its way through an increment.
    type :: reloading
        real(wp) :: share         !! of the share at the start, 0 to 1 [-]
        real(wp) :: by_q(2)       !! d(share)/dq [1/L]
        real(wp) :: by_pressure   !! d(share)/d(pressure) [L^2/F]
    end type reloading

contains

    !> Where traction and strength both change linearly, their ratio moves along a straight line,
    !> from the unit vector `e` (the traction starts on its surface) to q/reach; its least
    !> magnitude is its distance from zero.
    pure subroutine find_reloading(u_et, q, reach, by_pressure, blur, reload)
        real(wp), intent(in) :: u_et(2)    !! elastic tangential displacement at the start [L]
        real(wp), intent(in) :: q(2)       !! the same at the end, without slip [L]
        real(wp), intent(in) :: reach      !! the elastic displacement that the strength at the end
                                           !! allows [L]
        real(wp), intent(in) :: by_pressure   !! d(reach)/d(pressure) [L^3/F]
        real(wp), intent(in) :: blur       !! round-off of `u_et`, if that has lost its own [L]
        type(reloading), intent(out) :: reload
        real(wp), parameter :: round_off = 8.0_wp * epsilon(round_off)
        real(wp) :: e(2), way(2), start, length, ahead, aside, straight

        reload = reloading(share=1.0_wp, by_q=[0.0_wp, 0.0_wp], by_pressure=0.0_wp)
        start = hypot(u_et(1), u_et(2))
        if (.not. start > blur) return
        e = u_et / start
        way = q - reach * e
        length = hypot(way(1), way(2))
        straight = (round_off + blur / start) * hypot(q(1), q(2))
        if (.not. length > straight) return   ! nowhere
        way = way / length
        ahead = e(1) * way(1) + e(2) * way(2)
        if (ahead >= 0.0_wp .or. q(1) * way(1) + q(2) * way(2) <= 0.0_wp) return
        aside = e(1) * q(2) - e(2) * q(1)   ! the part of the way along e has no share in it
        reload%share = 0.0_wp
        if (abs(aside) <= straight) return   ! through zero, where |aside| has a kink
        aside = aside / length
        reload%share = abs(aside)
        ahead = ahead / length
        reload%by_q = sign(ahead, -aside) * [-way(2), way(1)]
        reload%by_pressure = reload%share * ahead * by_pressure
    end subroutine find_reloading

end module friction_reloading
